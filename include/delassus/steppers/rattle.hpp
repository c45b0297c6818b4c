/// Störmer and Verlet's method with joints held in position and velocity.
#pragma once

#include <delassus/core/expect.hpp>
#include <delassus/integrators/integrator.hpp>
#include <delassus/steppers/inner/rattle_step.hpp>
#include <delassus/steppers/inner/whole_steps.hpp>

namespace delassus {

/// Half a kick, free motion, half a kick; φ(q₊) = 0 and H₊ v₊ = 0. Second order, symmetric and symplectic:
/// the energy varies by O(h²) and does not drift, and steps that are turned back return to the start. Explicit:
/// stable for h ω < 2, ω also of springs and of what swings sideways under a tension; a heavy chain at a large
/// step wants `NewtonMidpoint`.
///
/// For rigid bodies, particles, and laws whose rows are equalities, so no contacts; soft rows are forces. The
/// solver, the compliance and the stabilisation of the loop are not asked. The free rotation of bodies is that of
/// `LiePoisson`. Source: [LeimkuhlerMatthews2016].
struct Rattle {
  using plays = role::Integrator;
  static constexpr int order = 2;  ///< read by `ErrorControlled`
  template <class P>
  using State = RattleStep<typename P::World, typename P::Laws, typename P::Rows>;
  /// Rigid bodies and particles.
  template <class Set>
  static constexpr bool can_move = requires {
    typename Set::Path;
  };
  double tolerance =
      1e-12;  ///< of what the joints are apart at the end, in units of the way of the fastest body
  int max_iterations = 20;  ///< factorizations of a part; reaching it is a status
  /// Parts of the free motion, each of which closes the joints, between the same two kicks. Most of what the energy
  /// varies by is the free motion's own, with joints that bend its way.
  int drifts = 1;

  void check() const {
    inner::check_newton("Rattle", tolerance, max_iterations);
    inner::expect_above_zero("Rattle: drifts", drifts);
  }
  /// The stages Linearize to Correct; all islands are solved as one, without W.
  void move(auto& step) const { inner::solve_at_once(step); }
  SystemScale scale(double) const { return {.mass = 1}; }
  /// p ← h f, N·s. Asked twice a step, so that f need not be that of the start.
  void impulse(const auto& set, auto& p, double h) const { inner::kick(set, p, h); }
  void advance(auto& set, double h) const { set.finish_step(h); }
};
static_assert(Integrator<Rattle>);

}  // namespace delassus
