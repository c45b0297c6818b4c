/// What collision detection is given and what it answers.
#pragma once

#include <delassus/core/index.hpp>
#include <delassus/core/roles.hpp>
#include <delassus/geometry/shape.hpp>
#include <delassus/math/pose.hpp>

#include <concepts>
#include <cstdint>
#include <span>
#include <vector>

namespace delassus {

/// Which pairs may collide, besides their groups: `NoFilter` says all.
struct NoFilter {
  /// Asked with the `pair_key` of two colliders: true for each.
  constexpr bool lets(std::uint64_t) const { return true; }
};

/// A posed, moving shape. m, m/s, rad/s, world frame.
struct Collider {
  Shape shape{};  ///< without one nothing is touched
  Pose pose{};  ///< from the axes of the shape to the world's
  Vec3 velocity = zero<Vec3>();  ///< of the origin of the pose, m/s
  Vec3 angular_velocity = zero<Vec3>();  ///< rad/s, axes of the world
  bool is_movable = true;  ///< two colliders that neither move are never paired
  bool goes_alone = true;  ///< nothing that moves is known to push it: it will go with `velocity`
  std::uint32_t group = 1;  ///< bits that the other one's `collides_with` is asked for
  std::uint32_t collides_with = ~0u;  ///< pairs when each one's group meets the other's mask
  std::uint32_t key = 0;              ///< names this collider from step to step; unique

  /// Of its point at x, world frame.
  Vec3 velocity_at(const Vec3& x) const { return velocity + cross(angular_velocity, Vec3(x - pose.position)); }
};

/// One of them moves, and each one's group meets the other's mask.
inline bool may_meet(const Collider& a, const Collider& b) {
  return (a.is_movable || b.is_movable) && (a.group & b.collides_with) != 0 && (b.group & a.collides_with) != 0;
}

/// The key of block b of set s in a loop's world.
constexpr std::uint32_t collider_key(Index s, Index b) { return (std::uint32_t(s) << 28) | std::uint32_t(b); }

/// Names a pair, whichever of the two is named first.
constexpr std::uint64_t pair_key(std::uint32_t a, std::uint32_t b) {
  return std::uint64_t(a < b ? a : b) << 32 | (a < b ? b : a);
}

/// One contact. `a` and `b` index the colliders of this call, key of a < key of b. World frame.
struct ContactPoint {
  /// Places among the colliders of the call: of the smaller key.
  Index a = -1, b = -1;  ///< and of the larger key
  /// Witness on A, m.
  Vec3 point_a = zero<Vec3>(), point_b = zero<Vec3>();  ///< point_b − point_a = gap · normal
  Vec3 normal = unit_axis(2);                           ///< unit, from A to B
  double gap = 0;                                       ///< m, negative when the bodies overlap
  std::uint64_t pair = 0;                               ///< key of a · 2³² + key of b
  std::uint32_t feature = 0;  ///< names the point within its pair, kept from step to step
  double area = 0;            ///< m², of the faces that touch what this point stands for; 0: no more than itself
  Vec3 middle = zero<Vec3>();  ///< of that, on average, m: its place where friction brakes a spin
  /// From the point of A to the point of B that will touch within the step, m, about `point()`: the impulse acts on each body at its own
  /// point. Zero where it acts on both at `point()`.
  Vec3 travel = zero<Vec3>();

  /// Between the witnesses.
  Vec3 point() const { return 0.5 * (point_a + point_b); }
  /// The same contact with B named first.
  void exchange_bodies() {
    std::swap(a, b);
    std::swap(point_a, point_b);
    normal = -normal;
    travel = -travel;
  }
};

/// Counts of one call: pairs the broad phase offered, pairs whose distance was computed, answers of the
/// kernel that the certificate refused (the native kernel answered instead), contact points.
struct CollisionReport {
  Index pairs = 0 /**< offered by the broad phase */, queries = 0 /**< distances computed */, rejects = 0 /**< refused answers */, points = 0;  ///< contacts
};

/// Answers with the contact points of this step, sorted by pair and feature.
template <class C>
concept CollisionBackend = Plays<C, role::Collision> &&
    requires(C backend, std::span<const Collider> colliders, double h, std::vector<ContactPoint>& points) {
      { backend.detect(colliders, h, points) } -> std::same_as<CollisionReport>;
    };

}  // namespace delassus
