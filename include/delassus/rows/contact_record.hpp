/// What collision detection tells the constraints about one contact point.
#pragma once

#include <delassus/rows/anchor.hpp>

#include <cstdint>

namespace delassus {

/// A pair of witnesses. `normal` points from A to B (unit, world); gap = normal · (point_b − point_a), m, negative
/// when the bodies overlap. `pair` and `feature` name the contact from step to step.
struct ContactRecord {
  Anchor a, b;
  Vec3 point_a = zero<Vec3>(), point_b = zero<Vec3>();
  Vec3 normal = unit_axis(2);
  double gap = 0;
  std::uint64_t pair = 0;
  std::uint32_t feature = 0;
  Index material_a = 0, material_b = 0;

  /// The one world point at which the impulse acts on both bodies, so that momentum is kept exactly.
  Vec3 point() const { return 0.5 * (point_a + point_b); }
};

}  // namespace delassus
