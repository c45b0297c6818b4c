/// A contact of a step with its impulse.
#pragma once

#include <delassus/math/linear.hpp>
#include <delassus/rows/contact_record.hpp>

namespace delassus {

/// A contact as a host reads it after the step: `impulse` (N·s, world) is what body B received from A.
struct ContactResult {
  ContactRecord record;  ///< where they meet
  Vec3 impulse = zero<Vec3>();  ///< world, N·s, on B
  bool starts_cold = false;  ///< the impulse is no start for the next step
  bool is_sliding = false;   ///< the friction impulse is as large as the cone allows
};

}  // namespace delassus
