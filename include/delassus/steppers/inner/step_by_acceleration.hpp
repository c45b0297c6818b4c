/// A whole step of points with elastic forces, solved for the acceleration at its end.
#pragma once

#include <delassus/core/array.hpp>
#include <delassus/core/cmath.hpp>
#include <delassus/core/status.hpp>
#include <delassus/steppers/inner/step_by_sets.hpp>

#include <algorithm>
#include <concepts>
#include <cstdint>
#include <limits>
#include <vector>

namespace delassus {

/// What a rule keeps of a point from one step to the next: two of its accelerations.
template <class V>
struct PastMotion {
  V first, second;
};
/// Where a point goes in a step, x₊ − x, and the velocity it gets.
template <class V>
struct PointMotion {
  V moved, velocity;
};

namespace inner {

/// How x₊ and v₊ of a point follow from y = v̇₊, v and what is kept of its past.
template <class R, class V>
concept AccelerationRule = requires(const R rule, const V& v, const PastMotion<V>& past, const V& y) {
  { rule.velocity_share() } -> std::same_as<double>;  // ∂v₊/∂y, s
  { rule.place_share() } -> std::same_as<double>;     // ∂x₊/∂y, s²
  { rule.begin(y) } -> std::same_as<PastMotion<V>>;   // of a point that has none
  { rule.guess(past) } -> std::same_as<V>;            // of y
  { rule.move(v, past, y) } -> std::same_as<PointMotion<V>>;
  { rule.keep(past, y) } -> std::same_as<PastMotion<V>>;  // for the next step
};

/// M y = f(x₊, v₊) for y = v̇₊, where the integrator's `rule(h)` says how x₊ and v₊ follow from it: by
/// Newton's method with A = M + D ∂v₊/∂y + K ∂x₊/∂y at x₊. A point that was not there in the last step, or
/// was placed or given another velocity since, begins with the past of a = f/M.
template <class Set>
struct StepByAcceleration {
  using Velocity = typename Set::Velocity;
  using T = typename Set::Scalar;
  std::vector<PastMotion<Velocity>> past;
  Array<Velocity> next, moved, v, p;  ///< y, x₊ − x, v at the start, impulses
  Array<Velocity> left_x, left_v;     ///< x and v as the last step left them
  Array<std::uint32_t> generation;    ///< of the point whose past this is

  void memory(auto& archive) { archive(past, moved, left_x, left_v, generation); }

  /// Leaves (x₊ − x)/h in v_next and v₊ in v_free; x and v as they were.
  template <class I>
  Status solve(Set& set, const I& integrator, double h, int& factorizations) {
    const AccelerationRule<Velocity> auto rule = integrator.rule(h);
    begin(set, rule);
    for (const Index b : set.active()) next[b] = rule.guess(past[b]);
    set.shift(0);  // sets x aside
    Status status = Status::max_iterations;
    double last = 0;
    const double rounding = std::numeric_limits<T>::epsilon() * inner::reach(set) / (h * h);
    for (int k = 0; k < integrator.max_iterations && status == Status::max_iterations; ++k) {
      place(set, rule);
      set.factor({.mass = 1, .damping = rule.velocity_share(), .stiffness = rule.place_share()});
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
      if (change <= std::max(integrator.tolerance * size, rounding))
        status = Status::converged;
      else if (k > 0 && change > 0.5 * last && change <= 1e-7 * size)
        status = Status::stalled;
      last = change;
    }
    place(set, rule);
    set.restore();
    for (const Index b : set.active()) {
      set.v_free[b] = set.velocity()[b];
      set.v_next[b] = set.moves(b) ? Velocity(moved[b] / T(h)) : v[b];
    }
    set.velocity() = v;
    for (const Index b : set.active()) {
      if (!set.moves(b)) continue;
      if (!is_finite(set.v_next[b]) || !is_finite(set.v_free[b])) {
        moved[b].setZero();
        continue;
      }
      past[b] = rule.keep(past[b], next[b]);
      left_x[b] = set.pose(b).position.template cast<T>() + moved[b];
      left_v[b] = set.v_free[b];
    }
    return status;
  }

 private:
  void begin(Set& set, const AccelerationRule<Velocity> auto& rule) {
    const std::size_t n = std::size_t(set.blocks()), before = generation.size();
    for (auto* array : {&next, &moved, &p, &left_x, &left_v}) array->resize(n);
    past.resize(n);
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
      past[b] = rule.begin(p[b]);
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
  /// x ← x₊ and v ← v₊ of the present y.
  void place(Set& set, const AccelerationRule<Velocity> auto& rule) {
    set.restore();
    for (const Index b : set.active()) {
      set.velocity()[b] = v[b];
      if (!set.moves(b)) continue;
      const PointMotion<Velocity> motion = rule.move(v[b], past[b], next[b]);
      moved[b] = motion.moved;
      set.velocity()[b] = motion.velocity;
      set.displace(b, moved[b]);
    }
  }
};

}  // namespace inner

/// The set goes to x₊, and takes v₊: what `advance` of an integrator by this step does.
void arrive_with_velocity(auto& set, double h) {
  set.advance(h);
  auto& v = set.velocity();
  for (const Index b : set.active())
    if (set.moves(b) && is_finite(set.v_next[b]) && is_finite(set.v_free[b])) v[b] = set.v_free[b];
}

}  // namespace delassus
