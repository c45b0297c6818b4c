/// Implicit steps of deformable bodies on their own, solved to the end by Newton's method.
#pragma once

#include <delassus/core/expect.hpp>
#include <delassus/integrators/integrator.hpp>
#include <delassus/steppers/inner/elastic_newton_step.hpp>
#include <delassus/steppers/inner/whole_steps.hpp>

namespace delassus {

/// With v̄ = (1 − θ) v + θ v₊: M (v₊ − v) = h f(q ⊕ θ h v̄), q₊ = q ⊕ h v̄. `ImplicitEuler` makes one Newton step
/// of this and lags behind what stiffens or turns fast. For soft bodies and rods without joints and contacts,
/// undamped.
///
/// With θ = 1, implicit Euler, it is of first order, and the energy does not rise. With θ = ½, the midpoint rule, it is
/// of second order and keeps momentum and angular momentum. Then the energy of a motion that is stiff within a step
/// swings.
struct FullNewton {
  using plays = role::Integrator;
  static constexpr int order = 2;  ///< read by `ErrorControlled`
  template <class P>
  using State = StepBySets<inner::ElasticNewton, typename P::World, typename P::Laws>;
  /// Soft bodies and rods.
  template <class Set>
  static constexpr bool can_move = requires(const Set& set) {
    set.elastic_energy();
  };
  double theta = 1;          ///< 1 or ½
  double tolerance = 1e-12;  ///< of the last change of the velocities, as a share of the largest
  int max_iterations = 50;   ///< factorizations; reaching it is a status

  void check() const {
    inner::expect_number(theta == 1 || theta == 0.5, "FullNewton: theta", theta,
                         "must be 1, implicit Euler, or 0.5, the midpoint rule");
    inner::check_newton("FullNewton", tolerance, max_iterations);
  }
  void move(auto& step) const { inner::solve_at_once(step); }  ///< the stages Linearize to Correct
  SystemScale scale(double) const { return {.mass = 1}; }
  void impulse(const auto& set, auto& p, double h) const { inner::kick(set, p, h); }  ///< p ← h f, N·s
  void advance(auto& set, double h) const {
    if (theta == 1)
      set.advance(h);
    else
      set.advance_midpoint(h);
  }
};
static_assert(Integrator<FullNewton>);

}  // namespace delassus
