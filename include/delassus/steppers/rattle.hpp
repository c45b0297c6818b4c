/// Störmer and Verlet's method with joints held in position and velocity.
#pragma once

#include <delassus/core/expect.hpp>
#include <delassus/integrators/integrator.hpp>
#include <delassus/steppers/inner/rattle_step.hpp>
#include <delassus/steppers/inner/whole_steps.hpp>

namespace delassus {

/// Half a kick, free motion, half a kick; φ(q₊) = 0 and H₊ v₊ = 0. Second order, symmetric and symplectic:
/// the energy varies by O(h²) and does not drift, and steps that are turned back return to the start. Forces
/// are asked twice a step, so they need not be those of the start. Explicit: stable for h ω < 2, ω also of
/// springs and of what swings sideways under a tension; a heavy chain at a large step wants `NewtonMidpoint`.
/// For rigid bodies, particles, and laws whose rows are equalities, so no contacts; soft rows are forces. All
/// islands are solved as one, without W; the solver, the compliance and the stabilisation of the loop are not
/// asked. The free rotation of bodies is that of `LiePoisson`.
///
/// Most of what the energy varies by is the free motion's own, with joints that bend its way: `drifts` closes
/// them at the ends of its parts, between the same two kicks. A double pendulum of points let go level, 1.24
/// mJ at 1 ms, varies by 0.44 mJ in two parts and 0.28 in three. Source: [LeimkuhlerMatthews2016].
struct Rattle {
  using plays = role::Integrator;
  template <class P>
  using State = RattleStep<typename P::World, typename P::Laws, typename P::Rows>;
  template <class Set>
  static constexpr bool can_move = requires {
    typename Set::Path;
  };
  double tolerance =
      1e-12;  ///< of what the joints are apart at the end, in units of the way of the fastest body
  int max_iterations = 20;  ///< factorizations of a part; reaching it is a status
  int drifts = 1;           ///< parts of the free motion, each of which closes the joints

  void check() const {
    inner::check_newton("Rattle", tolerance, max_iterations);
    inner::expect_above_zero("Rattle: drifts", drifts);
  }
  void move(auto& step) const { inner::solve_at_once(step); }
  SystemScale scale(double) const { return {.mass = 1}; }
  void impulse(const auto& set, auto& p, double h) const { inner::kick(set, p, h); }
  void advance(auto& set, double h) const { set.finish_step(h); }
};
static_assert(Integrator<Rattle>);

}  // namespace delassus
