/// Soft contact: an overlap is pushed out like a damped spring of given frequency, whatever the masses.
#pragma once

#include <delassus/core/expect.hpp>
#include <delassus/stabilisation/stabilisation.hpp>

#include <algorithm>
#include <cmath>
#include <limits>

namespace delassus {

/// With ω = 2π f, m = 1/W_nn, k = m ω², c = 2 ζ m ω, implicit Euler of the spring gives
///
///   u + φ ω/(2ζ + h ω) + R λ = 0,   R = W_nn / (h ω (2ζ + h ω)).
///
/// At rest a mass m sags by g/ω² · (what it carries)/m. Joints are held as by Baumgarte at `joint_rate`,
/// at most at `max_joint_speed`.
struct SoftContact {
  using plays = role::Stabilisation;
  double frequency = 30;     ///< f, Hz
  double damping_ratio = 1;  ///< ζ
  double max_speed = 1;      ///< m/s
  double joint_rate = 0.2;
  double max_joint_speed = std::numeric_limits<double>::infinity();  ///< m/s, rad/s

  void check() const {
    DELASSUS_EXPECT(frequency > 0 && std::isfinite(frequency),
                    "SoftContact: frequency " + inner::text(frequency) + " must be finite and > 0 Hz");
    DELASSUS_EXPECT(damping_ratio >= 0 && std::isfinite(damping_ratio),
                    "SoftContact: damping_ratio " + inner::text(damping_ratio) + " must be finite and >= 0");
    DELASSUS_EXPECT(max_speed > 0, "SoftContact: max_speed " + inner::text(max_speed) + " must be > 0 m/s");
    DELASSUS_EXPECT(joint_rate >= 0 && joint_rate <= 1,
                    "SoftContact: joint_rate " + inner::text(joint_rate) + " must be in [0, 1]");
    DELASSUS_EXPECT(max_joint_speed > 0,
                    "SoftContact: max_joint_speed " + inner::text(max_joint_speed) + " must be > 0 m/s");
  }
  double omega() const { return 6.283185307179586 * frequency; }
  double equality(double phi, double h) const {
    return std::clamp(joint_rate * phi / h, -max_joint_speed, max_joint_speed);
  }
  double penetration(double phi, double h) const {
    return std::max(phi * omega() / (2 * damping_ratio + h * omega()), -max_speed);
  }
  double softness(double h) const { return 1 / (h * omega() * (2 * damping_ratio + h * omega())); }
};
static_assert(Stabilisation<SoftContact>);

}  // namespace delassus
