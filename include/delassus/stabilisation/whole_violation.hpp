/// The whole violation is corrected within one step.
#pragma once

#include <delassus/core/expect.hpp>
#include <delassus/stabilisation/stabilisation.hpp>

#include <algorithm>

namespace delassus {

/// bias = φ/h: the constraint holds at the end of the step to first order. Push-out at most at `max_speed` (m/s).
struct WholeViolation {
  using plays = role::Stabilisation;
  double max_speed = 1;  ///< m/s

  void check() const { inner::expect_above_zero("WholeViolation: max_speed", max_speed, "m/s"); }
  double equality(double phi, double h) const { return phi / h; }
  double penetration(double phi, double h) const { return std::max(phi / h, -max_speed); }
};
static_assert(Stabilisation<WholeViolation>);

}  // namespace delassus
