/// The bodies as laws see them: where an anchor is, and what moves it.
#pragma once

#include <delassus/core/array.hpp>
#include <delassus/core/expect.hpp>
#include <delassus/core/index.hpp>
#include <delassus/math/fits.hpp>
#include <delassus/math/linear.hpp>
#include <delassus/rows/anchor.hpp>
#include <delassus/rows/body_set.hpp>
#include <delassus/rows/row_system.hpp>
#include <delassus/rows/surface_motion.hpp>

#include <cstdint>
#include <string>
#include <type_traits>

namespace delassus {

/// What laws ask of a body set, as functions of the set. Rows of H are R × width numbers a block, by columns, for every block of the
/// anchor one after the other.
template <class T>
struct SetTable {
  /// Whether the anchor speaks of this set; refuses one whose body was removed.
  bool (*owns)(const void* set, const Anchor&, const char* what);
  bool (*is_current)(const void* set, const Anchor&);  ///< the body behind it is still there
  std::uint32_t (*generation)(const void* set, Index block);  ///< of the body there: who takes its place has another one
  Vec3 (*point)(const void* set, const Anchor&);
  Quat (*frame)(const void* set, const Anchor&);  ///< null: its bodies have no orientation
  Mat3 (*axes)(const void* set, const Anchor&);   ///< null: those of `frame`
  void (*add_blocks)(const void* set, const Anchor&, Array<Index>& blocks);
  /// Row k of H += that of the velocity of `point` along `direction`.
  void (*along)(const void* set, const Anchor&, const Vec3& point, const Vec3& direction, T* H, int R, int k);
  /// The first three rows of H += those of the velocity of `point` along the rows of `axes`, times `sign`.
  void (*along_three)(const void* set, const Anchor&, const Vec3& point, const Mat3& axes, double sign, T* H, int R);
  /// The same along the axes of the world.
  void (*along_axes)(const void* set, const Anchor&, const Vec3& point, double sign, T* H, int R);
  /// Row k of H += that of the rate of turn about `axis`; null: nothing turns.
  void (*about)(const void* set, const Anchor&, const Vec3& axis, T* H, int R, int k);
  /// How the surface behind the anchor moves at `point`; null: it is of no rigid body.
  SurfaceMotion (*surface)(const void* set, const Anchor&, const Vec3& point);
};

namespace inner {

/// The functions of one set.
template <class Set, class T>
struct SetFunctions {
  static const Set& of(const void* set) { return *static_cast<const Set*>(set); }

  static bool owns(const void* set, const Anchor& a, const char* what) {
    if (of(set).owner() != a.owner) return false;
    using Handle = std::remove_cvref_t<decltype(of(set).handle(0))>;
    DELASSUS_EXPECT(of(set).contains(Handle{a.block, a.generation, a.owner}),
                    std::string(what) + ": " + of(set).who(a.block) + " was removed; its anchor is stale");
    return true;
  }
  static bool is_current(const void* set, const Anchor& a) {
    return of(set).is_alive(a.block) && of(set).handle(a.block).generation == a.generation;
  }
  static std::uint32_t generation(const void* set, Index block) { return of(set).handle(block).generation; }
  static Vec3 point(const void* set, const Anchor& a) { return of(set).point(a); }
  static constexpr bool has_frame = requires(const Set& set, const Anchor& a) { set.frame(a); };
  static constexpr bool has_axes = requires(const Set& set, const Anchor& a) { set.axes(a); };
  static constexpr bool turns = requires(const Set& set, const Anchor& a, Vec3 axis) { set.about(a, 0, axis); };

  static Quat frame([[maybe_unused]] const void* set, const Anchor& a) {
    if constexpr (has_frame) return of(set).frame(a);
    else return a.frame;
  }
  static Mat3 axes([[maybe_unused]] const void* set, const Anchor& a) {
    if constexpr (has_axes) return of(set).axes(a);
    else return frame(set, a).toRotationMatrix();
  }
  static void add_blocks(const void* set, const Anchor& a, Array<Index>& blocks) {
    const int count = of(set).anchor_blocks(a);
    for (int k = 0; k < count; ++k) blocks.push_back(of(set).anchor_block(a, k));
  }

  /// Row k of H += x.
  [[gnu::always_inline]] static void add(const auto& x, T* H, int R, int k) {
    for (int j = 0; j < Set::width; ++j) H[R * j + k] += T(x[j]);
  }
  static void along(const void* set, const Anchor& a, const Vec3& point, const Vec3& direction, T* H, int R, int k) {
    const int count = of(set).anchor_blocks(a);
    for (int b = 0; b < count; ++b, H += R * Set::width) add(of(set).along(a, b, point, direction), H, R, k);
  }
  static void along_three(const void* set, const Anchor& a, const Vec3& point, const Mat3& axes, double sign, T* H, int R) {
    const int count = of(set).anchor_blocks(a);
    if constexpr (HasInverseInertia<Set> && Set::width == 6) {
      if (count == 0) return;
      const Vec3 r = point - of(set).centre(a.block);
      for (int k = 0; k < 3; ++k) {
        const double d[3] = {sign * axes(k, 0), sign * axes(k, 1), sign * axes(k, 2)};
        for (int i = 0; i < 3; ++i) {
          const int j = (i + 1) % 3, l = (i + 2) % 3;
          H[R * i + k] += T(d[i]);
          H[R * (3 + i) + k] += T(r[j] * d[l] - r[l] * d[j]);
        }
      }
      return;
    }
    for (int b = 0; b < count; ++b, H += R * Set::width)
      for (int k = 0; k < 3; ++k)
        add(of(set).along(a, b, point, Vec3(sign * axes(k, 0), sign * axes(k, 1), sign * axes(k, 2))), H, R, k);
  }
  /// With r from the centre of a body to the point, v + ω × r = [1, −skew(r)] (v, ω).
  static void along_axes(const void* set, const Anchor& a, const Vec3& point, double sign, T* H, int R) {
    if constexpr (HasInverseInertia<Set> && Set::width == 6) {
      if (of(set).anchor_blocks(a) == 0) return;
      const Vec3 r = sign * (point - of(set).centre(a.block));
      const T x = T(r[0]), y = T(r[1]), z = T(r[2]);
      const T minus_cross[3][3] = {{0, z, -y}, {-z, 0, x}, {y, -x, 0}};
      for (int k = 0; k < 3; ++k) {
        H[R * k + k] += T(sign);
        for (int i = 0; i < 3; ++i) H[R * (3 + k) + i] += minus_cross[i][k];
      }
    } else {
      for (int k = 0; k < 3; ++k) along(set, a, point, sign * unit_axis(k), H, R, k);
    }
  }
  static void about([[maybe_unused]] const void* set, [[maybe_unused]] const Anchor& a, [[maybe_unused]] const Vec3& axis,
                    [[maybe_unused]] T* H, [[maybe_unused]] int R, [[maybe_unused]] int k) {
    if constexpr (turns) {
      const int count = of(set).anchor_blocks(a);
      for (int b = 0; b < count; ++b, H += R * Set::width) add(of(set).about(a, b, axis), H, R, k);
    }
  }

  static constexpr bool has_surface = requires(const Set& set, const Anchor& a, Vec3 point) { set.surface(a, point); };
  static SurfaceMotion surface([[maybe_unused]] const void* set, [[maybe_unused]] const Anchor& a, [[maybe_unused]] const Vec3& point) {
    if constexpr (has_surface) return of(set).surface(a, point);
    else return {};
  }

  /// Those of the functions that a set has.
  static constexpr SetTable<T> make_table() {
    return {owns,       is_current, generation,  point,      has_frame ? frame : nullptr, has_axes ? axes : nullptr,
            add_blocks, along,      along_three, along_axes, turns ? about : nullptr,     has_surface ? surface : nullptr};
  }
  static const SetTable<T> table;
};

template <class Set, class T>
constinit const SetTable<T> SetFunctions<Set, T>::table = make_table();

}  // namespace inner

/// A set of a world and its functions.
template <class T>
struct SetView {
  const void* set;
  const SetTable<T>* table;
};

/// A world as laws see it: its sets by number, and no more of their types than the scalar.
template <class T>
class WorldView {
 public:
  using Scalar = T;

  WorldView(const SetView<T>* sets, int count) : sets_(sets), count_(count) {}

  /// Where an anchor is in the world now, m. One that no loop has seen, fresh from `anchor(set, body)`, is looked for among the
  /// sets; those of removed bodies and of other worlds are refused then.
  Vec3 point(const Anchor& a) const {
    if (a.set >= 0) return set(a).table->point(set(a).set, a);
    if (a.owner != 0) [[unlikely]] return point(found(a, "point"));
    return a.local;
  }
  /// Of the body behind an end of a contact.
  std::uint32_t generation(const Anchor& a) const { return set(a).table->generation(set(a).set, a.block); }
  /// How the frame of an anchor is turned in the world now; a particle has none and says its anchor's own.
  Quat frame(const Anchor& a) const {
    if (a.set < 0 && a.owner != 0) [[unlikely]] return frame(found(a, "frame"));
    if (a.set >= 0 && set(a).table->frame) return set(a).table->frame(set(a).set, a);
    return a.frame;
  }
  /// The same as a matrix: its axes are the columns. Between the ends of a step of the midpoint rule it is no rotation.
  Mat3 axes(const Anchor& a) const {
    if (a.set >= 0 && set(a).table->axes) return set(a).table->axes(set(a).set, a);
    return frame(a).toRotationMatrix();
  }
  /// How the surface behind an anchor moves at a point of the world, m; unknown but of a rigid body.
  SurfaceMotion surface(const Anchor& a, const Vec3& point) const {
    return set(a).table->surface ? set(a).table->surface(set(a).set, a, point) : SurfaceMotion{};
  }
  /// Whether the body behind an anchor is still there; the world always is.
  bool is_current(const Anchor& a) const { return a.set < 0 || set(a).table->is_current(set(a).set, a); }
  const SetView<T>& set(const Anchor& a) const { return sets_[a.set]; }

 private:
  Anchor found(Anchor a, const char* what) const {
    while (++a.set < count_)
      if (set(a).table->owns(set(a).set, a, what)) return a;
    throw_stranger(what);
  }
  [[noreturn]] static void throw_stranger(const char* what) {
    throw InvalidArgument("delassus: " + std::string(what) + ": the anchor belongs to a body of another world");
  }

  const SetView<T>* sets_;
  int count_;
};

namespace inner {

/// The velocities of all sets by number, as numbers by block.
template <class World>
struct BodyVelocities {
  using T = typename World::Scalar;
  const T *free[World::set_count + 1], *start[World::set_count + 1], *next[World::set_count + 1];

  explicit BodyVelocities(const World& world) {
    world.each([&](const auto& set, auto s) __attribute__((always_inline)) {
      free[s] = reinterpret_cast<const T*>(set.v_free.data());
      start[s] = reinterpret_cast<const T*>(set.velocity().data());
      next[s] = reinterpret_cast<const T*>(set.v_next.data());
    });
  }
};

}  // namespace inner

/// The view of a world, with room for what it says of its sets.
template <class World>
class ViewOf : public WorldView<typename World::Scalar> {
  using T = typename World::Scalar;

 public:
  ViewOf() : WorldView<T>(of_set_, World::set_count) {}  ///< of nothing, before it is attached
  explicit ViewOf(const World& world) : ViewOf() { attach(world); }

  /// The world may have moved with its loop.
  void attach(const World& world) {
    if (of_ == &world) return;
    of_ = &world;
    world.each([&](const auto& set, auto s) __attribute__((always_inline)) {
      of_set_[s] = {&set, &inner::SetFunctions<std::remove_cvref_t<decltype(set)>, T>::table};
    });
  }
  /// A copy is of nothing.
  ViewOf(const ViewOf&) : ViewOf() {}
  ViewOf& operator=(const ViewOf&) {
    of_ = nullptr;
    return *this;
  }

 private:
  const void* of_ = nullptr;
  SetView<T> of_set_[World::set_count + 1];
};

}  // namespace delassus
