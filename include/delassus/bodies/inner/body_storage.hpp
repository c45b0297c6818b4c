/// What every set keeps of a body besides its state: its place, its velocities and load, and whom it meets.
#pragma once

#include <delassus/bodies/inner/quarantine_record.hpp>
#include <delassus/core/array.hpp>
#include <delassus/core/expect.hpp>
#include <delassus/core/handle.hpp>
#include <delassus/core/known_materials.hpp>
#include <delassus/core/slots.hpp>
#include <delassus/math/linear.hpp>
#include <delassus/rows/body_set.hpp>

#include <cstddef>
#include <cstdint>
#include <string>
#include <type_traits>

namespace delassus::inner {

/// A set of bodies derives from it. `Set` is that set: it types the handles, and `Set::kind` is the word for
/// its bodies.
template <class Set, class T, int width_>
class BodyStorage {
 public:
  using Scalar = T;
  using Handle = delassus::Handle<Set>;
  using Velocity = Vec<width_, T>;
  static constexpr int width = width_;

  Vec3 gravity{0, 0, -9.81};
  Array<Velocity> v_free, v_next;

  bool contains(Handle body) const {
    return body.owner == owner_ && slots_.is_current(body.index, body.generation);
  }
  /// Of the body with this number, or of the one that was there last. Throws InvalidArgument for a number that none ever had.
  Handle handle(Index block) const {
    DELASSUS_EXPECT(block >= 0 && block < slots_.size(), "handle: " + who(block) + " was never added");
    return {block, slots_.generation(block), owner_};
  }
  std::uint32_t owner() const { return owner_; }
  std::string who(Index b) const { return std::string(Set::kind) + " #" + std::to_string(b); }

  Index blocks() const { return slots_.size(); }
  SetVersion version() const { return {owner_, slots_.removals(), slots_.size()}; }
  const Array<Index>& active() const { return slots_.active(); }
  bool is_alive(Index b) const { return slots_.is_alive(b); }
  bool is_awake(Index b) const { return slots_.is_awake(b); }
  /// Puts a body to sleep where it is: it is in no list of `active`, and its velocity reads zero.
  void put_to_sleep(Index b) {
    slots_.set_awake(b, false);
    set_zero(v_[b]), set_zero(v_free[b]), set_zero(v_next[b]);
  }
  void wake(Index b) { slots_.set_awake(b, true); }

  const Velocity& load(Index b) const { return load_[b]; }
  /// N and N·m; each is taken when its body has moved.
  Array<Velocity>& loads() { return load_; }
  /// At the start of the step, and of kinematic bodies for this one.
  const Array<Velocity>& velocity() const { return v_; }
  Array<Velocity>& velocity() { return v_; }
  /// How many bodies the last advance left where they were.
  Index quarantined() const { return quarantine_.count; }
  const QuarantineRecord& quarantine_record() const { return quarantine_; }

  /// While it is closed, during a step, no body can be added.
  void close(bool is_closed) { is_closed_ = is_closed; }

  Index material(Index b) const { return material_[b]; }
  /// Whether every body that was ever added has a material from 0 to `count`.
  bool keeps_to_materials(Index count) const { return least_material_ >= 0 && most_material_ <= count; }
  std::uint32_t group(Index b) const { return group_[b]; }
  std::uint32_t collides_with(Index b) const { return collides_with_[b]; }

 protected:
  Index checked(Handle body) const {
    DELASSUS_EXPECT(body.owner == owner_,
                    wrong_handle(body.owner, Set::kind,
                                 std::string("this ") + Set::kind + " handle belongs to another world"));
    DELASSUS_EXPECT(slots_.is_current(body.index, body.generation),
                    who(body.index) + " was removed; its handle is stale");
    return body.index;
  }

  /// Refuses a body while a step runs, and one of a material that was never added.
  void check_new(Index material, const std::string& name) const {
    DELASSUS_EXPECT(!is_closed_, name + ": it is added while a step runs, whose arrays have no place for it; add it after the step");
    DELASSUS_EXPECT(material >= 0 && material <= largest_material(),
                    name + ": material " + std::to_string(material) +
                        " was never added; give it what loop.materials().add({...}) returns, or none");
  }
  /// A place for a body as the user gave it, with this velocity; the arrays of the state are the set's to fit
  /// to `blocks()`.
  Index take(const auto& body, const Velocity& velocity) {
    check_new(body.material, who(slots_.size()));
    const Index b = slots_.take();
    const std::size_t n = std::size_t(slots_.size());
    v_.resize(n), load_.resize(n), v_free.resize(n), v_next.resize(n);
    material_.resize(n), group_.resize(n), collides_with_.resize(n);
    assign(v_[b], velocity), assign(v_free[b], velocity), assign(v_next[b], velocity);
    set_zero(load_[b]);
    material_[b] = body.material;
    note_material(body.material);
    group_[b] = body.group;
    collides_with_[b] = body.collides_with;
    return b;
  }

  /// What outlives a step; handles of the set that wrote it stay with that set.
  void memory(auto& archive) {
    archive(gravity, slots_, v_, load_, v_free, v_next, material_, group_, collides_with_);
    if (archive.reads)
      for (const Index material : material_) note_material(material);
  }

  Slots slots_;
  QuarantineRecord quarantine_;
  Array<Velocity> v_, load_;

 private:
  void note_material(Index material) {
    if (material < least_material_) least_material_ = material;
    if (material > most_material_) most_material_ = material;
  }

  std::uint32_t owner_ = next_owner();
  bool is_closed_ = false;
  Index least_material_ = 0, most_material_ = 0;
  Array<Index> material_;
  Array<std::uint32_t> group_, collides_with_;
};

}  // namespace delassus::inner
