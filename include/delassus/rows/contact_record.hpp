/// What collision detection tells the constraints about one contact point.
#pragma once

#include <delassus/rows/anchor.hpp>

#include <cstdint>

namespace delassus {

/// A pair of witnesses. `normal` points from A to B (unit, world); gap = normal · (point_b − point_a), m, negative
/// when the bodies overlap. `pair` and `feature` name the contact from step to step.
struct ContactRecord {
  /// Of the body with the smaller key.
  Anchor a{}, b{};  ///< of the other one
  /// On A, world, m.
  Vec3 point_a = zero<Vec3>(), point_b = zero<Vec3>();  ///< on B, world, m
  Vec3 normal = unit_axis(2);  ///< unit, from A to B, world
  double gap = 0;              ///< m, < 0 where they overlap
  std::uint64_t pair = 0;      ///< key of A · 2³² + key of B
  std::uint32_t feature = 0;   ///< the point within its pair, kept from step to step
  /// A number that `Materials` gave; 0: none was given.
  Index material_a = 0, material_b = 0;  ///< of B
  /// From `point()` to where friction acts, across the normal, m. Zero but in patches, whose friction acts at their mean distance
  /// from the middle of the load, and their normal impulses at their corners.
  Vec3 friction_arm = zero<Vec3>();
  /// From the point of A to the point of B that will touch within the step, m, about `point()`: the impulse acts on each body at its own
  /// point. Zero but where bodies that are apart meet elsewhere than at their nearest points, or one of them answers to no impulse.
  Vec3 travel = zero<Vec3>();

  /// The middle of the contact. Without travel the normal impulse acts here on both bodies, which keeps the angular momentum exactly.
  Vec3 point() const { return 0.5 * (point_a + point_b); }
  /// Where the part across the normal acts, likewise.
  Vec3 friction_point() const { return point() + friction_arm; }
};

}  // namespace delassus
