/// The last stage before the motors: a low-pass filter and a limit.
#pragma once

#include <delassus/core/cmath.hpp>
#include <delassus/core/expect.hpp>
#include <delassus/math/linear.hpp>

#include <limits>
#include <numbers>
#include <type_traits>

namespace delassus {

/// y ← y + α (x − y), α = 1 − exp(−2π f T), then |y| brought down to the limit, its direction kept.
///
/// A filter delays by about 1/(2π f): the stiffness that stays passive falls from 2 b/T to 2 b/(T + 1/(π f)), see
/// docs/theory/haptics.md. It is off by default. A force that is not finite becomes zero, and the filter starts anew.
struct ForceOutput {
  double cutoff = std::numeric_limits<double>::infinity();      ///< f, Hz
  double period = 1e-3;                                         ///< T of a tick, s
  double max_force = std::numeric_limits<double>::infinity();   ///< N
  double max_torque = std::numeric_limits<double>::infinity();  ///< N·m

  void check() const {
    inner::expect_above_zero("ForceOutput: cutoff", cutoff, "Hz");
    inner::expect_positive("ForceOutput: period", period, "s");
    inner::expect_at_least_zero("ForceOutput: max_force", max_force, "N");
    inner::expect_at_least_zero("ForceOutput: max_torque", max_torque, "N·m");
  }

  /// α; 1 without a filter.
  double share() const { return std::isinf(cutoff) ? 1 : -std::expm1(-2 * std::numbers::pi * cutoff * period); }

  /// One tick of one vector: `filtered` is the filter's memory.
  template <class T>
  Vec<3, T> operator()(const std::type_identity_t<Vec<3, T>>& wanted, double limit, Vec<3, T>& filtered) const {
    using Vector = Vec<3, T>;
    filtered = is_finite(wanted) ? Vector(filtered + share() * (wanted - filtered)) : Vector(zero<Vector>());
    const T size = norm(filtered);
    return size > limit ? Vector(limit / size * filtered) : filtered;
  }
};

}  // namespace delassus
