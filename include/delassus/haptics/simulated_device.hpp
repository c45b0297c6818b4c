/// A haptic device and the hand that holds it, as a mass, springs and dampers: for tests and for trying out.
#pragma once

#include <delassus/core/expect.hpp>
#include <delassus/haptics/device_state.hpp>
#include <delassus/math/linear.hpp>


namespace delassus {

/// m ẍ = F − b ẋ + K (x_h − x) + B (ẋ_h − ẋ). What the motors exert is F, held for the time of a tick, b the friction of the
/// device, K and B the hand, which wants to be at x_h. The orientation is fixed.
///
/// Advanced by the implicit midpoint rule, which keeps its energy balance to rounding for any step. For a hand that holds still,
///   Δ(½ m v² + ½ K (x_h − x)²) = F·Δx − b v̄² dt − B …,  v̄ = Δx/dt.
/// Energy that appears in a closed loop therefore does not come from here.
struct SimulatedDevice {
  double mass = 0.1;             ///< m, kg
  double friction = 1;           ///< b, N·s/m
  double hand_stiffness = 300;   ///< K, N/m
  double hand_damping = 2;       ///< B, N·s/m
  Vec3 position = zero<Vec3>();  ///< x, m
  Vec3 velocity = zero<Vec3>();  ///< m/s
  Vec3 hand = zero<Vec3>();      ///< x_h, m
  Vec3 hand_velocity = zero<Vec3>();  ///< ẋ_h, m/s

  void check() const {
    inner::expect_positive("SimulatedDevice: mass", mass, "kg");
    DELASSUS_EXPECT(friction >= 0 && hand_stiffness >= 0 && hand_damping >= 0,
                    "SimulatedDevice: friction and the hand's stiffness and damping must be >= 0");
  }

  /// What a driver would tell.
  DeviceState state() const { return {.position = position, .velocity = velocity}; }

  /// `seconds` under a constant force, in `steps` steps. x_h moves with its velocity.
  void advance(const Vec3& force, double seconds, int steps = 10) {
    const double dt = seconds / steps;
    for (int n = 0; n < steps; ++n) {
      // (m + dt/2 (b + B) + dt²/4 K) v̄ = m v + dt/2 (F + B ẋ_h + K (x_h + dt/2 ẋ_h − x)),  x₊ = x + dt v̄,  v₊ = 2 v̄ − v.
      const Vec3 pull = hand_stiffness * (hand + dt / 2 * hand_velocity - position) + hand_damping * hand_velocity;
      const double inertia = mass + dt / 2 * (friction + hand_damping) + dt * dt / 4 * hand_stiffness;
      const Vec3 mean = (mass * velocity + dt / 2 * (force + pull)) / inertia;
      position += dt * mean;
      velocity = 2 * mean - velocity;
      hand += dt * hand_velocity;
      lost_to_friction += dt * friction * squared_norm(mean);
    }
  }

  double lost_to_friction = 0;  ///< ∫ b ẋ² dt, J

  /// ½ m v² + ½ K |x_h − x|², J.
  double energy() const {
    return 0.5 * mass * squared_norm(velocity) + 0.5 * hand_stiffness * squared_norm(hand - position);
  }
};

}  // namespace delassus
