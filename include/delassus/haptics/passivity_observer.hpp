/// Watches whether what a device displays gives out more energy than it took in.
#pragma once

#include <delassus/math/linear.hpp>

#include <algorithm>
#include <cstddef>

namespace delassus {

/// E_n = −Σ F_k · (x_(k+1) − x_k) − Σ τ_k · Δθ_k, J: the work the hand and the device have done against the forces displayed,
/// exact for forces that are held between samples. The display is passive while E ≥ 0; with the friction of the device
/// counted in, E + ∫ b ẋ² dt ≥ 0. Source: [HannafordRyu2002].
class PassivityObserver {
 public:
  /// `force` was displayed while the device moved by `moved` (m), and `torque` while it turned by `turned` (rad).
  void add(const Vec3& force, const Vec3& moved, const Vec3& torque = zero<Vec3>(), const Vec3& turned = zero<Vec3>()) {
    energy_ -= dot(force, moved) + dot(torque, turned);
    least_ = std::min(least_, energy_);
  }

  /// E now, J.
  double energy() const { return energy_; }
  /// The smallest E so far; 0 if it was never below.
  double least() const { return least_; }
  /// E ≥ 0 now; `least` tells of the time before.
  bool is_passive() const { return energy_ >= 0; }

 private:
  double energy_ = 0, least_ = 0;
};

}  // namespace delassus
