/// The implicit midpoint rule solved to rounding, joints and bodies together, by Newton's method.
#pragma once

#include <delassus/core/expect.hpp>
#include <delassus/integrators/integrator.hpp>
#include <delassus/steppers/inner/hold_at_midpoint.hpp>
#include <delassus/steppers/inner/whole_steps.hpp>

#include <type_traits>

namespace delassus {

/// q₊ = q ⊕ h (v + v₊)/2 with φ(q₊) = 0 and constraint forces along H at the mean of q and q₊. Second order. Where φ
/// is quadratic in q (all joints but couplings, screws and lengths; a rigid length too) it keeps energy to rounding,
/// with that of springs and rotors on any coordinate, and nothing drifts. The matrix of Newton's method has the geometric stiffness of forces at points, so that light
/// links under a heavy load hold at large steps: see docs/decisions/0010.
///
/// For rigid bodies and laws whose rows are equalities, so no contacts. Forces are those of the start of the step. All
/// islands are solved as one. The solver, the compliance and the stabilisation of the loop are not asked.
struct NewtonMidpoint {
  using plays = role::Integrator;
  static constexpr int order = 2;  ///< read by `ErrorControlled`
  template <class P>
  using State = std::conditional_t<(P::Laws::pool_count > 0), MidpointHold<typename P::World, typename P::Laws, typename P::Rows>,
                                   MidpointAlone<typename P::World>>;
  /// Rigid bodies.
  template <class Set>
  static constexpr bool can_move = requires { typename Set::Midpoint; };
  static constexpr bool knows_rotors = true;  ///< see `RotorInertia`
  double tolerance = 1e-10;  ///< of what is missing in every equation, in units of the largest velocity
  /// Factorizations; reaching it is a status. With 1, and `acceptable` = ∞, a step is one linear solve and takes half
  /// the time: what it leaves open the next one closes.
  int max_iterations = 20;
  double acceptable = 1e-3;  ///< of the same, when they run out: a step that misses more is not taken; ∞ takes any
  int max_halvings = 6;      ///< how often a step that does not converge is halved before that

  void check() const {
    inner::check_newton("NewtonMidpoint", tolerance, max_iterations);
    inner::expect_at_least_zero("NewtonMidpoint: acceptable", acceptable);
    inner::expect_at_least_zero("NewtonMidpoint: max_halvings", max_halvings);
  }
  /// The stages Linearize to Correct. Where no finite impulse closes the joints, as in a chain drawn straight, rows yield by
  /// 1e-10 of their W, with status `stalled`.
  void move(auto& step) const { inner::solve_at_once(step); }
  SystemScale scale(double) const { return {.mass = 1}; }
  void impulse(const auto& set, auto& p, double h) const { inner::kick(set, p, h); }  ///< p ← h f, N·s
  void advance(auto& set, double h) const { set.finish_step(h); }
};
static_assert(Integrator<NewtonMidpoint>);

}  // namespace delassus
