/// Baumgarte's rate: a share of the violation is taken back each step.
#pragma once

#include <delassus/core/expect.hpp>
#include <delassus/stabilisation/stabilisation.hpp>

#include <algorithm>
#include <limits>

namespace delassus {

/// bias = rate · φ/h. A contact is pushed out at most at `max_speed`, a joint closed at most at `max_joint_speed`, where one is
/// given. What was put together far apart, or meets a step much shorter than the last, then comes home and is not shot there.
struct Baumgarte {
  using plays = role::Stabilisation;
  double rate = 0.2;            ///< share of φ per step, in (0, 1]
  double max_speed = 1;         ///< m/s
  double max_joint_speed = std::numeric_limits<double>::infinity();  ///< m/s, rad/s

  void check() const {
    inner::expect_number(rate > 0 && rate <= 1, "Baumgarte: rate", rate, "must be in (0, 1]");
    inner::expect_above_zero("Baumgarte: max_speed", max_speed, "m/s");
    inner::expect_above_zero("Baumgarte: max_joint_speed", max_joint_speed, "m/s");
  }
  double equality(double phi, double h) const { return std::clamp(rate * phi / h, -max_joint_speed, max_joint_speed); }
  double penetration(double phi, double h) const { return std::max(rate * phi / h, -max_speed); }
};
static_assert(Stabilisation<Baumgarte>);

}  // namespace delassus
