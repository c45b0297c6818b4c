/// What a haptic device tells and what it is told.
#pragma once

#include <delassus/math/linear.hpp>
#include <delassus/solvers/solve_report.hpp>

#include <cstdint>

namespace delassus {

/// Pose and velocity of the part of a device that the hand holds, world axes, m and m/s, rad/s. A device that cannot
/// measure velocity may leave it zero: the damping of the coupling then acts on the tool alone.
struct DeviceState {
  Vec3 position = zero<Vec3>();  ///< m
  Quat orientation = Quat::Identity();  ///< from the axes of what is held to the world's
  Vec3 velocity = zero<Vec3>();  ///< m/s
  Vec3 angular_velocity = zero<Vec3>();  ///< rad/s

  /// No number is infinite or NaN, and |orientation|² lies between 1/4 and 4.
  bool is_finite() const {
    const double square = squared_norm(orientation.coeffs());
    return delassus::is_finite(position) && delassus::is_finite(velocity) && delassus::is_finite(angular_velocity) &&
           square > 0.25 && square < 4;
  }
};

/// What the device shall exert on the hand, N and N·m, world axes, and how it came about.
struct HapticForce {
  Vec3 force = zero<Vec3>();  ///< N
  Vec3 torque = zero<Vec3>();  ///< N·m
  SolveReport solve{};  ///< of this tick; `quarantined` where numbers were not finite
  std::uint64_t sequence = 0;  ///< of the snapshot it was computed from; 0: none yet
  double snapshot_time = 0;    ///< s, simulated, at the start of the snapshot's step
};

}  // namespace delassus
