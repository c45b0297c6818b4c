/// A whole step of deformable bodies by Newton's method: for `FullNewton`.
#pragma once

#include <delassus/core/array.hpp>
#include <delassus/core/cmath.hpp>
#include <delassus/core/status.hpp>
#include <delassus/fem/inner/slope_search.hpp>
#include <delassus/steppers/inner/step_by_sets.hpp>

#include <algorithm>
#include <limits>
#include <span>

namespace delassus::inner {

/// With w the mean velocity of the step,
///
///   M (w − v) = θ h f(q ⊕ θ h w),   v₊ = v + (w − v)/θ,   q₊ = q ⊕ h w,
///
/// θ = 1 implicit Euler, θ = ½ the midpoint rule. Newton's method in w with A = M + (θ h)² K at q ⊕ θ h w,
/// and a search along each of its steps by the slope. Where K is not the whole derivative of f, as that of a
/// rod, it converges linearly.
template <class Set>
struct ElasticNewton {
  using Velocity = typename Set::Velocity;
  using T = typename Set::Scalar;
  Array<Velocity> v, w, trial, residual, step;
  Array<char> is_out;  ///< by body: its step is no number

  template <class I>
  Status solve(Set& set, const I& integrator, double h, int& factorizations) {
    const double theta = integrator.theta;
    const double ahead = theta * h;
    v = w = trial = set.velocity();
    for (auto* array : {&residual, &step}) array->resize(v.size());
    is_out.assign(v.size(), 0);
    set.shift(0);  // sets the places aside
    const double crossing = inner::reach(set) / ahead;
    Status status = Status::max_iterations, worst = Status::converged;
    double last = 0;
    for (int k = 0; k < integrator.max_iterations && status == Status::max_iterations; ++k) {
      look(set, w, ahead, {.mass = 1, .stiffness = ahead * ahead});
      ++factorizations;
      step = residual;
      set.solve(step);
      if (leave_out(set)) worst = Status::quarantined;
      const double change = largest(set, step);
      const double size = std::max({largest(set, w), largest(set, v), h * double(set.gravity.norm())});
      // Slopes are rounding there: no search.
      const bool is_near = change <= std::max(1e-7 * size, 1e-10 * crossing);
      const double s = is_near ? 1 : slope_search(1, work_along(set, residual, step), [&](double share) {
        go(set, share);
        look(set, trial, ahead, {.mass = 1});
        return work_along(set, residual, step);
      });
      go(set, s);
      w = trial;
      if (s == 1 && change <= std::max(integrator.tolerance * size, rounding * crossing))
        status = Status::converged;
      else if (k > 0 && change >= last && is_near)
        status = Status::stalled;
      last = change;
    }
    finish(set, theta);
    return worse(status, worst);
  }

  static constexpr double rounding = std::numeric_limits<T>::epsilon();
  /// Bodies with a step that is no number take part no more: they stand still, and their residual is
  /// nothing. Bodies of a set do not couple, so that the others go on.
  bool leave_out(const Set& set) {
    bool any = false;
    for (const Index b : set.active())
      if (set.moves(b) && !is_finite(step[b])) any = true, is_out[set.body_of(b)] = 1;
    if (any) silence(set);
    return any;
  }
  void silence(const Set& set) {
    for (const Index b : set.active())
      if (is_out[set.body_of(b)]) residual[b].setZero(), step[b].setZero(), w[b] = trial[b] = v[b];
  }

  /// trial ← w + s step.
  void go(const Set& set, double s) {
    for (const Index b : set.active())
      if (set.moves(b)) trial[b] = w[b] + T(s) * step[b];
  }
  /// v₊ of w; of a body that was left out no number, so that it stays where it is.
  void finish(Set& set, double theta) {
    set.restore();
    set.velocity() = v;
    for (const Index b : set.active()) {
      set.v_free[b] = set.v_next[b] = v[b];
      if (!set.moves(b)) continue;
      if (is_out[set.body_of(b)])
        set.v_next[b].setConstant(std::numeric_limits<T>::quiet_NaN());
      else
        set.v_free[b] = set.v_next[b] = v[b] + T(1 / theta) * Velocity(w[b] - v[b]);
    }
  }

  /// residual ← θ h f(q ⊕ θ h u) − M (u − v), M of the start, where impulses act; K and A of q ⊕ θ h u
  /// made.
  void look(Set& set, std::span<const Velocity> u, double ahead, SystemScale scale) {
    set.restore();
    auto& difference = set.velocity();
    for (const Index b : set.active()) difference[b] = u[b] - v[b];
    for (Velocity& x : residual) x.setZero();
    set.add_mass_times_velocity(residual, -1 / ahead);
    for (const Index b : set.active())
      if (set.moves(b)) set.displace(b, Velocity(T(ahead) * u[b]));
    set.factor(scale);
    set.add_forces(residual);
    for (const Index b : set.active()) residual[b] *= T(ahead);
    silence(set);
  }
};

}  // namespace delassus::inner
