/// Soft contact: an overlap is pushed out like a damped spring of given frequency, whatever the masses.
#pragma once

#include <delassus/core/expect.hpp>
#include <delassus/stabilisation/stabilisation.hpp>

#include <algorithm>
#include <limits>

namespace delassus {

/// With ω = 2π f, m = 1/W_nn, k = m ω², c = 2 ζ m ω, implicit Euler of the spring gives
///
///   u + φ ω/(2ζ + h ω) + R λ = 0,   R = W_nn / (h ω (2ζ + h ω)).
///
/// At rest a mass m sags by g/ω² · (what it carries)/m. Joints are held as by Baumgarte at `joint_rate`, at most at
/// `max_joint_speed`.
struct SoftContact {
  using plays = role::Stabilisation;
  double frequency = 30;     ///< f, Hz
  double damping_ratio = 1;  ///< ζ
  double max_speed = 1;      ///< m/s
  double joint_rate = 0.2;  ///< share of φ per step, in [0, 1]
  double max_joint_speed = std::numeric_limits<double>::infinity();  ///< m/s, rad/s

  void check() const {
    inner::expect_positive("SoftContact: frequency", frequency, "Hz");
    inner::expect_not_negative("SoftContact: damping_ratio", damping_ratio);
    inner::expect_above_zero("SoftContact: max_speed", max_speed, "m/s");
    inner::expect_zero_to_one("SoftContact: joint_rate", joint_rate);
    inner::expect_above_zero("SoftContact: max_joint_speed", max_joint_speed, "m/s");
  }
  /// ω, rad/s.
  double omega() const { return 6.283185307179586 * frequency; }
  double equality(double phi, double h) const {
    return std::clamp(joint_rate * phi / h, -max_joint_speed, max_joint_speed);
  }
  double penetration(double phi, double h) const {
    return std::max(phi * omega() / (2 * damping_ratio + h * omega()), -max_speed);
  }
  double relative_compliance(double h) const { return 1 / (h * omega() * (2 * damping_ratio + h * omega())); }
};
static_assert(Stabilisation<SoftContact>);

}  // namespace delassus
