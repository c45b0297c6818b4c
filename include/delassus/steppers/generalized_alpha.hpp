/// The generalised-α method: second order, with the damping of what the step cannot resolve chosen by one
/// number.
#pragma once

#include <delassus/core/expect.hpp>
#include <delassus/integrators/integrator.hpp>
#include <delassus/steppers/inner/alpha_rule.hpp>
#include <delassus/steppers/inner/whole_steps.hpp>

namespace delassus {

/// For structures: particles on springs and soft bodies, without joints and contacts. Implicit, solved by
/// Newton's method; stable for every h ω. A motion with h ω → ∞ shrinks by ρ∞ a step, one with h ω ≪ 1 keeps
/// its amplitude to third order. A force that begins or ends with a step acts half in its neighbour, since a
/// lags: the method is for what changes smoothly.
struct GeneralizedAlpha {
  using plays = role::Integrator;
  static constexpr int order = 2;  ///< read by `ErrorControlled`
  template <class P>
  using State = StepBySets<inner::StepByAcceleration, typename P::World, typename P::Laws>;
  /// Particles and soft bodies.
  template <class Set>
  static constexpr bool can_move = Set::width == 3;
  double spectral_radius = 0.8;  ///< ρ∞ in [0, 1]
  double tolerance = 1e-10;      ///< of the accelerations
  int max_iterations = 20;       ///< factorizations; reaching it is a status

  /// For a step of h (s): α_m, α_f, β and γ of ρ∞.
  inner::AlphaRule rule(double h) const {
    const double rho = spectral_radius, alpha_m = (2 * rho - 1) / (rho + 1), alpha_f = rho / (rho + 1);
    const double step = 1 - alpha_m + alpha_f;
    return {alpha_m, alpha_f, step * step / 4, step - 0.5, h};
  }
  void check() const {
    inner::expect_zero_to_one("GeneralizedAlpha: spectral_radius", spectral_radius);
    inner::check_newton("GeneralizedAlpha", tolerance, max_iterations);
  }
  void move(auto& step) const { inner::solve_at_once(step); }  ///< the stages Linearize to Correct
  SystemScale scale(double) const { return {.mass = 1}; }
  void impulse(const auto& set, auto& p, double h) const { inner::kick(set, p, h); }  ///< p ← h f, N·s
  void advance(auto& set, double h) const { arrive_with_velocity(set, h); }
};
static_assert(Integrator<GeneralizedAlpha>);

}  // namespace delassus
