/// A whole step of the generalised-α method for points with elastic forces: for `GeneralizedAlpha`.
#pragma once

#include <delassus/core/status.hpp>
#include <delassus/loop/stages/step_by_sets.hpp>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>
#include <vector>

namespace delassus {

namespace inner {

/// With v̇ the acceleration and a the one that moves x,
///
///   (1 − α_m) a₊ + α_m a = (1 − α_f) v̇₊ + α_f v̇,   M v̇₊ = f(x₊, v₊),
///   x₊ = x + h v + h² ((½ − β) a + β a₊),   v₊ = v + h ((1 − γ) a + γ a₊),
///
/// by Newton's method in v̇₊ with A = M + h γ′ D + h² β′ K at x₊. v̇ and a of the last step are kept; a body
/// that was not there then, or was placed or given another velocity since, begins with f/M. A force that
/// begins or ends with a step acts half in its neighbour, since a lags: the method is for what changes
/// smoothly. Source: docs/references.md, [ChungHulbert1993], [ArnoldBruls2007] eq. (6).
template <class Set>
struct GeneralizedAlphaOfSet {
  using Velocity = typename Set::Velocity;
  using T = typename Set::Scalar;
  std::vector<Velocity> a, rate, next, moved, v, p;  ///< a, v̇, v̇₊, x₊ − x, v at the start, impulses
  std::vector<Velocity> left_x, left_v;              ///< x and v as the last step left them
  std::vector<std::uint32_t> generation;             ///< of the body whose a and v̇ these are

  void memory(auto& archive) { archive(a, rate, left_x, left_v, generation); }

  /// a = v̇ = f/M for bodies that are new.
  void begin(Set& set) {
    const std::size_t n = std::size_t(set.blocks()), before = generation.size();
    for (auto* array : {&a, &rate, &next, &moved, &p, &left_x, &left_v}) array->resize(n);
    generation.resize(n, 0);
    v = set.velocity();
    bool any = false;
    for (const Index b : set.active()) any = any || is_new(set, b, before);
    if (!any) return;
    set.factor({.mass = 1});
    pull(set);
    answer(set);
    for (const Index b : set.active()) {
      if (!is_new(set, b, before)) continue;
      a[b] = rate[b] = p[b];
      generation[b] = set.handle(b).generation;
    }
  }
  bool is_new(const Set& set, Index b, std::size_t before) const {
    if (!set.moves(b)) return false;
    if (std::size_t(b) >= before || generation[b] != set.handle(b).generation) return true;
    const Velocity x = set.pose(b).position.template cast<T>();
    constexpr T rounding = 64 * std::numeric_limits<T>::epsilon();
    return (x - left_x[b]).norm() > rounding * (x.norm() + moved[b].norm()) ||
           (v[b] - left_v[b]).norm() > rounding * left_v[b].norm();
  }
  void pull(const Set& set) {
    for (auto& x : p) x.setZero();
    set.add_forces(p);
  }
  /// p ← A⁻¹ p.
  void answer(Set& set) {
    if (set.is_coupled()) return set.solve(p);
    for (const Index b : set.active()) {
      if (set.moves(b))
        p[b] = set.template solve_block<1>(b, p[b]);
      else
        p[b].setZero();
    }
  }

  template <class I>
  Status solve(Set& set, const I& integrator, double h, int& factorizations) {
    begin(set);
    const auto c = integrator.coefficients();
    const double share = (1 - c.alpha_f) / (1 - c.alpha_m);
    set.shift(0);  // sets x aside
    next = rate;
    Status status = Status::max_iterations;
    double last = 0;
    for (int k = 0; k < integrator.max_iterations && status == Status::max_iterations; ++k) {
      place(set, c, h);
      set.factor({.mass = 1, .damping = h * c.gamma * share, .stiffness = h * h * c.beta * share});
      pull(set);
      set.velocity() = next;
      set.add_mass_times_velocity(p, -1);
      answer(set);
      ++factorizations;
      double change = 0, size = 0;
      for (const Index b : set.active()) {
        if (!set.moves(b)) continue;
        next[b] += p[b];
        change = std::max(change, double(p[b].norm()));
        size = std::max({size, double(next[b].norm()), double(v[b].norm()) / h});
      }
      if (change <= integrator.tolerance * size)
        status = Status::converged;
      else if (k > 0 && change > 0.5 * last && change <= 1e-7 * size)
        status = Status::stalled;
      last = change;
    }
    place(set, c, h);
    set.restore();
    for (const Index b : set.active()) {
      set.v_free[b] = set.velocity()[b];
      set.v_next[b] = set.moves(b) ? Velocity(moved[b] / T(h)) : v[b];
    }
    set.velocity() = v;
    for (const Index b : set.active()) {
      if (!set.moves(b) || !is_finite(set.v_next[b]) || !is_finite(set.v_free[b])) continue;
      const Velocity now = acceleration(c, b);
      a[b] = now;
      rate[b] = next[b];
      left_x[b] = set.pose(b).position.template cast<T>() + moved[b];
      left_v[b] = set.v_free[b];
    }
    return status;
  }
  template <class C>
  Velocity acceleration(const C& c, Index b) const {
    return T(1 / (1 - c.alpha_m)) *
           (T(1 - c.alpha_f) * next[b] + T(c.alpha_f) * rate[b] - T(c.alpha_m) * a[b]);
  }
  /// x ← x₊ and v ← v₊ of the present v̇₊.
  template <class C>
  void place(Set& set, const C& c, double h) {
    set.restore();
    for (const Index b : set.active()) {
      set.velocity()[b] = v[b];
      if (!set.moves(b)) continue;
      const Velocity now = acceleration(c, b);
      moved[b] = T(h) * v[b] + T(h * h) * (T(0.5 - c.beta) * a[b] + T(c.beta) * now);
      set.velocity()[b] = v[b] + T(h) * (T(1 - c.gamma) * a[b] + T(c.gamma) * now);
      set.displace(b, moved[b]);
    }
  }
};

}  // namespace inner

template <class World, class Laws, class Rows>
class GeneralizedAlphaStep : public StepBySets<inner::GeneralizedAlphaOfSet, World> {
  static_assert(
      Rows::pool_count == 0,
      "delassus: GeneralizedAlpha moves bodies without joints; take the laws out, or use ImplicitMidpoint");
};

}  // namespace delassus
