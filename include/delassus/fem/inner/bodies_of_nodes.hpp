/// What sets of deformable bodies share: bodies of nodes, whose blocks are the nodes.
#pragma once

#include <delassus/bodies/inner/body_storage.hpp>
#include <delassus/core/array.hpp>
#include <delassus/rows/asked_nodes.hpp>
#include <delassus/rows/body_set.hpp>

#include <span>
#include <string>
#include <utility>
#include <vector>

namespace delassus::inner {

/// `Storage` is what the set keeps of its nodes. `Elastic` is one body: its `blocks()`, its `solve` and its `compliance`. `Body` is what a user says of a
/// new one; a `Handle` names a node, a `BodyHandle` a body. `Set` holds nodes by `hold` and knows what
/// `moves`.
template <class Set, class Storage, class Body_, class Elastic>
class BodiesOfNodes : public Storage {
  using T = typename Storage::Scalar;

 public:
  using Body = Body_;
  using BodyHandle = delassus::Handle<Body>;
  using typename Storage::Handle, typename Storage::Velocity;
  static constexpr const char* kind = "node";

  /// Takes a body out, all its nodes with it.
  void remove(BodyHandle body) {
    const Index k = checked_body(body);
    for (const Index b : bodies_[k].blocks()) {
      self().set_fixed(b, true);
      slots_.release(b);
    }
    bodies_[k] = {};
    body_slots_.release(k);
  }

  /// Holds a node where it is, as the clamped end of a beam.
  void fix(Handle node, bool is_fixed = true) {
    const Index b = this->checked(node);
    is_fixed_[b] = is_fixed;
    if (is_fixed) v_[b].setZero();
    self().set_fixed(b, false);
  }
  void release(Handle node) { fix(node, false); }
  /// Fixes the nodes of a body for whose position (world, m) `where` is true; returns how many.
  Index fix(BodyHandle body, const auto& where) {
    Index count = 0;
    for (const Index b : bodies_[checked_body(body)].blocks())
      if (where(Vec3(self().pose(b).position))) fix(this->handle(b)), ++count;
    return count;
  }

  Index node_count(BodyHandle body) const { return Index(bodies_[checked_body(body)].blocks().size()); }
  /// Node k of a body, numbered as the points of its mesh or line.
  Handle node(BodyHandle body, Index k) const {
    const auto blocks = bodies_[checked_body(body)].blocks();
    DELASSUS_EXPECT(k >= 0 && k < Index(blocks.size()), body_name(body.index) + " has nodes 0 to " +
                                                            std::to_string(blocks.size() - 1) + ", not " +
                                                            std::to_string(k));
    return this->handle(blocks[k]);
  }

  bool may_sleep() const { return false; }
  /// The stiffness couples nodes; an explicit integrator leaves it out.
  bool is_coupled() const { return scale_.stiffness != 0; }
  /// f(a, b): what acts on block a moves block b.
  void each_tie(auto&& f) const {
    if (!is_coupled()) return;
    each_body([&](const auto& body) {
      Index last = -1;
      for (const Index b : body.blocks()) {
        if (!self().moves(b)) continue;
        if (last >= 0) f(last, b);
        last = b;
      }
    });
  }
  void solve(std::span<Velocity> x) const {
    each_body([&](const auto& body) { body.solve(x); });
  }
  /// The same by several workers, with the same bits; `by` is what they keep.
  template <class By, class E>
  void solve(std::span<Velocity> x, By& by, const E& execution) const {
    by.sort(body_slots_.active(), execution.workers(),
            [&](Index k) { return Index(bodies_[k].blocks().size()); });
    by.each_small(execution, [&](Index k) { bodies_[k].solve(x); });
    for (const Index k : by.large) bodies_[k].solve(x, by.at(k).factor, by.dense, execution);
  }
  void add_stiffness_times_velocity(std::span<Velocity> p, double s) const {
    each_body([&](const auto& body) { body.add_stiffness_times_velocity(p, v_, T(s)); });
  }
  /// "soft body #0, node #7".
  std::string name(Index b) const { return body_name(body_[b]) + ", " + this->who(b); }
  Index body_of(Index b) const { return body_[b]; }
  /// The number of a block among the nodes of its body.
  Index node_of(Index b) const { return node_[b]; }
  /// A⁻¹ at nodes of one body: what its rows of W are made of.
  void node_compliance(std::span<const Index> blocks, std::span<T> C) const {
    touched_.clear();
    for (const Index b : blocks) touched_.push_back(node_[b]);
    bodies_[body_[blocks.front()]].compliance(touched_, C);
  }
  /// The same of several bodies by several workers: those of body k are the blocks asked[k], C begins there
  /// at C + asked[k].C, and the bodies differ.
  template <class By, class E>
  void node_compliances(std::span<const Index> blocks, std::span<const AskedNodes> asked, T* C, By& by,
                        const E& execution) const {
    by.nodes.clear();
    for (const Index b : blocks) by.nodes.push_back(node_[b]);
    const std::span<const Index> nodes(by.nodes);
    const auto body_of = [&](const AskedNodes& a) { return body_[blocks[a.first]]; };
    const auto find = [&](const AskedNodes& a, auto&... with) {
      bodies_[body_of(a)].compliance(nodes.subspan(a.first, a.count),
                                     std::span<T>(C + a.C, a.size(Set::width)), with...);
    };
    by.small.clear();
    for (Index k = 0; k < Index(asked.size()); ++k)
      if (!By::is_large(Index(bodies_[body_of(asked[k])].blocks().size())))
        by.small.push_back(k);
      else
        find(asked[k], by.dense, execution);
    by.each_small(execution, [&](Index k) { find(asked[k]); });
  }

 protected:
  static std::string body_name(Index k) { return std::string(Set::body_kind) + " #" + std::to_string(k); }
  Index checked_body(BodyHandle body) const {
    DELASSUS_EXPECT(body.owner == this->owner(),
                    wrong_handle(body.owner, Set::body_kind,
                                 std::string("this ") + Set::body_kind + "'s handle belongs to another world"));
    DELASSUS_EXPECT(body_slots_.is_current(body.index, body.generation),
                    body_name(body.index) + " was removed; its handle is stale");
    return body.index;
  }

  /// A place for a new body; `give` puts it there.
  Index take_body(Index material) {
    this->check_new(material, body_name(body_slots_.size()));
    const Index k = body_slots_.take();
    bodies_.resize(body_slots_.size());
    return k;
  }
  /// A block for node `node` of body k; the arrays of its state are the set's to fit to `blocks()`.
  Index take_node(const Body& body, Index k, Index node, const Velocity& velocity) {
    const Index b = Storage::take(body, velocity);
    const std::size_t n = std::size_t(slots_.size());
    is_fixed_.resize(n), body_.resize(n), node_.resize(n);
    is_fixed_[b] = 0;
    body_[b] = k;
    node_[b] = node;
    return b;
  }
  BodyHandle give(Index k, Elastic body) {
    bodies_[k] = std::move(body);
    for (const Index b : bodies_[k].blocks()) self().set_fixed(b, false);
    return {k, body_slots_.generation(k), this->owner()};
  }

  /// A body is held whole: of its nodes those that were loaded badly are noted first.
  void note_held(const Elastic& body) {
    ++this->quarantine_.count;
    for (const Index b : body.blocks())
      if (!is_finite(this->load_[b])) this->quarantine_.note(b, false);
    this->quarantine_.note(body.blocks().front(), true);
  }

  void each_body(auto&& f) const {
    for (const Index k : body_slots_.active()) f(bodies_[k]);
  }
  void each_body(auto&& f) {
    for (const Index k : body_slots_.active()) f(bodies_[k]);
  }
  const Elastic& elastic(Index b) const { return bodies_[body_[b]]; }

  /// What outlives a step; the handles of the set that wrote it stay with that set.
  void memory(auto& archive) {
    Storage::memory(archive);
    archive(body_slots_, is_fixed_, body_, node_, bodies_);
  }

  using Storage::slots_, Storage::v_;
  SystemScale scale_;
  Slots body_slots_;
  std::vector<Elastic> bodies_;
  Array<char> is_fixed_;
  Array<Index> body_;  ///< of each block
  Array<Index> node_;  ///< its number in that body

 private:
  Set& self() { return static_cast<Set&>(*this); }
  const Set& self() const { return static_cast<const Set&>(*this); }

  mutable Array<Index> touched_;
};

}  // namespace delassus::inner
