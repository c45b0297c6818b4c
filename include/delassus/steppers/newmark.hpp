/// Newmark's method.
#pragma once

#include <delassus/core/expect.hpp>
#include <delassus/integrators/integrator.hpp>
#include <delassus/steppers/inner/alpha_rule.hpp>
#include <delassus/steppers/inner/whole_steps.hpp>

namespace delassus {

/// x₊ = x + h v + h² ((½ − β) v̇ + β v̇₊),  v₊ = v + h ((1 − γ) v̇ + γ v̇₊). Implicit, solved by Newton's method: the
/// generalised-α method without its averages. For particles on springs and soft bodies, without joints and
/// contacts. With β = ¼ and γ = ½ it is the trapezoidal rule: of second order, stable for every h ω, and keeping
/// the energy of linear forces. With γ > ½ it is of first order and damped. Source: docs/references.md, [Newmark1959].
struct Newmark {
  using plays = role::Integrator;
  static constexpr int order = 2;  ///< read by `ErrorControlled`
  template <class P>
  using State = StepBySets<inner::StepByAcceleration, typename P::World, typename P::Laws>;
  /// Particles and soft bodies.
  template <class Set>
  static constexpr bool can_move = Set::width == 3;
  double beta = 0.25;        ///< ≥ γ/2
  double gamma = 0.5;        ///< ≥ ½
  double tolerance = 1e-10;  ///< of the accelerations
  int max_iterations = 20;   ///< factorizations; reaching it is a status

  inner::AlphaRule rule(double h) const { return {0, 0, beta, gamma, h}; }  ///< for a step of h, s
  void check() const {
    inner::expect_number(gamma >= 0.5 && gamma <= 1, "Newmark: gamma", gamma, "must be in [0.5, 1]");
    inner::expect_number(beta >= gamma / 2 && beta <= 1, "Newmark: beta", beta,
                         "must be in [gamma/2, 1], where it is stable for every step");
    inner::check_newton("Newmark", tolerance, max_iterations);
  }
  void move(auto& step) const { inner::solve_at_once(step); }  ///< the stages Linearize to Correct
  SystemScale scale(double) const { return {.mass = 1}; }
  void impulse(const auto& set, auto& p, double h) const { inner::kick(set, p, h); }  ///< p ← h f, N·s
  void advance(auto& set, double h) const { arrive_with_velocity(set, h); }
};
static_assert(Integrator<Newmark>);

}  // namespace delassus
