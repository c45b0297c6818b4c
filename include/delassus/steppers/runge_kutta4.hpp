/// The classical Runge-Kutta method with joints.
#pragma once

#include <delassus/integrators/integrator.hpp>
#include <delassus/steppers/inner/runge_kutta_step.hpp>
#include <delassus/steppers/inner/whole_steps.hpp>

namespace delassus {

/// Four evaluations of forces and, where there are joints, of the accelerations they allow; the end of the
/// step is brought back onto the joints. Fourth order for smooth scenes: the cheapest way to many digits. It
/// keeps no invariant: over long runs energy leaks. Stable for h ω < 2.828. For rigid bodies, particles, and
/// laws whose rows are equalities, so no contacts; soft rows are forces. All islands are solved as one,
/// without W; the solver, the compliance and the stabilisation of the loop are not asked. Forces of the host
/// are those of the start, and constant over the step.
struct RungeKutta4 {
  using plays = role::Integrator;
  static constexpr int order = 4;  ///< read by `ErrorControlled`
  template <class P>
  using State = RungeKuttaStep<typename P::World, typename P::Laws, typename P::Rows>;
  /// Rigid bodies and particles.
  template <class Set>
  static constexpr bool can_move = requires {
    typename Set::Path;
  };
  double tolerance =
      1e-12;  ///< of what the joints are apart at the end, in units of the way of the fastest body
  int max_iterations = 20;  ///< factorizations of the projection; reaching it is a status

  void check() const { inner::check_newton("RungeKutta4", tolerance, max_iterations); }
  void move(auto& step) const { inner::solve_at_once(step); }  ///< the stages Linearize to Correct
  SystemScale scale(double) const { return {.mass = 1}; }
  void impulse(const auto& set, auto& p, double h) const { inner::kick(set, p, h); }  ///< p ← h f, N·s
  void advance(auto& set, double h) const { set.finish_step(h); }
};
static_assert(Integrator<RungeKutta4>);

}  // namespace delassus
