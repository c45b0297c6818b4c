/// The backward differentiation formula of second order.
#pragma once

#include <delassus/core/expect.hpp>
#include <delassus/integrators/integrator.hpp>
#include <delassus/steppers/inner/step_by_acceleration.hpp>
#include <delassus/steppers/inner/whole_steps.hpp>

namespace delassus {

namespace inner {

/// v₋ and x₋ being those of one step before v and x,
///
///   3/2 v₊ − 2 v + ½ v₋ = h v̇₊,   3/2 x₊ − 2 x + ½ x₋ = h v₊.
///
/// What is kept is a = (v − v₋)/h, and s = (v − (x − x₋)/h)/h, half of a where a is constant. Source:
/// docs/references.md, [HairerWanner1996] chapter V.1.
struct Bdf2Rule {
  double h;

  double velocity_share() const { return 2 * h / 3; }
  double place_share() const { return 4 * h * h / 9; }
  template <class V>
  PastMotion<V> begin(const V& acceleration) const {
    return {acceleration, typename V::Scalar(0.5) * acceleration};
  }
  template <class V>
  V guess(const PastMotion<V>& past) const {
    return past.first;
  }
  template <class V>
  PointMotion<V> move(const V& v, const PastMotion<V>& past, const V& next) const {
    using T = typename V::Scalar;
    const PastMotion<V> now = keep(past, next);
    const V velocity = v + T(h) * now.first;
    return {T(h) * (velocity - T(h) * now.second), velocity};
  }
  template <class V>
  PastMotion<V> keep(const PastMotion<V>& past, const V& next) const {
    using T = typename V::Scalar;
    const V a = T(1. / 3) * (T(2) * next + past.first);
    return {a, T(1. / 3) * (a + past.second)};
  }
};

}  // namespace inner

/// For structures that shall come to rest: particles on springs and soft bodies, without joints and contacts.
/// Of second order where implicit Euler is of first; stable for every h ω, and a motion with h ω → ∞ is gone
/// after a few steps. A step of another length than the last one is of first order.
struct Bdf2 {
  using plays = role::Integrator;
  template <class P>
  using State = StepBySets<inner::StepByAcceleration, typename P::World, typename P::Laws>;
  /// Particles and soft bodies.
  template <class Set>
  static constexpr bool can_move = Set::width == 3;
  double tolerance = 1e-10;  ///< of the accelerations
  int max_iterations = 20;   ///< factorizations; reaching it is a status

  inner::Bdf2Rule rule(double h) const { return {h}; }  ///< for a step of h, s
  void check() const { inner::check_newton("Bdf2", tolerance, max_iterations); }
  void move(auto& step) const { inner::solve_at_once(step); }  ///< the stages Linearize to Correct
  SystemScale scale(double) const { return {.mass = 1}; }
  void impulse(const auto& set, auto& p, double h) const { inner::kick(set, p, h); }  ///< p ← h f, N·s
  void advance(auto& set, double h) const { arrive_with_velocity(set, h); }
};
static_assert(Integrator<Bdf2>);

}  // namespace delassus
