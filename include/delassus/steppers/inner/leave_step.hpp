/// What a whole step with joints does with a result that is none: for `Rattle` and `RungeKutta4`.
#pragma once

#include <delassus/core/cmath.hpp>
#include <delassus/rows/rate.hpp>
#include <delassus/solvers/solve_report.hpp>
#include <delassus/steppers/inner/equalities.hpp>

#include <algorithm>
#include <limits>
#include <tuple>

namespace delassus::inner {

/// Where a law throws before the step is done, bodies are where it began, with the velocities they had.
template <class World, class Paths>
class BackUnlessDone {
 public:
  BackUnlessDone(World& world, Paths& paths) : world_(world), paths_(paths) {}
  BackUnlessDone(const BackUnlessDone&) = delete;
  ~BackUnlessDone() {
    if (is_done) return;
    world_.each([this](auto& set, auto s) {
      for (const Index b : set.active()) {
        std::get<s>(paths_).back(set.state(), b);
        set.velocity()[b] = std::get<s>(paths_).start_velocity(b);
      }
    });
  }
  bool is_done = false;

 private:
  World& world_;
  Paths& paths_;
};

/// The largest |φ + H G δ|, δ the impulses of H G δ = −φ that are least: what no small motion closes, m or
/// rad. Uses v_next.
template <class World, class Rows>
double contradiction(World& world, Rows& rows, Equalities<Rows>& equalities) {
  world.each([&](auto& set, auto s) {
    apply_inverse_to_all(set, rows, s);
    for (auto& v : set.v_next) v.setZero();
  });
  if (!equalities.factor(rows)) return 0;
  equalities.solve(
      rows, [&](auto p, Index i) { return rows.template pool<p>().phi[i]; },
      [&](auto p, Index i, const auto& change) {
        Equalities<Rows>::template push<p>(rows, i, change, next_of(world));
      });
  each_pool(rows, [&](auto, auto& pool) {
    for (Index i = 0; i < pool.items(); ++i) pool.phi[i] += next_rate(pool, i, world);
  });
  return Equalities<Rows>::worst(rows);
}

/// Whether all forces are numbers. Uses v_next.
template <class World, class I>
bool has_finite_forces(World& world, const I& integrator) {
  bool is_sound = true;
  world.each([&](auto& set, auto) {
    for (auto& p : set.v_next) p.setZero();
    integrator.impulse(set, set.v_next, 1);
    for (const Index b : set.active()) is_sound = is_sound && (!set.moves(b) || is_finite(set.v_next[b]));
  });
  return is_sound;
}

/// Keeps a step whose joints closed. One whose joints could not leaves every body in the place and with the
/// velocity it had: `infeasible` where even to first order no motion from there closes them, by more than a
/// thousandth of `way` (m), what the fastest body goes; `max_iterations` where one might; and bodies without
/// a velocity, for the loop to hold, where a force is no number.
template <class World, class Laws, class Rows, class I, class Paths>
void keep_or_leave(World& world, const Laws& laws, Rows& rows, const I& integrator,
                   Equalities<Rows>& equalities, Paths& paths, double way, SolveReport& report) {
  bool is_lost = !(report.status != Status::max_iterations || report.measure.residual <= 1e-3);
  world.each([&](const auto& set, auto) {
    for (const Index b : set.active())
      is_lost = is_lost || (Rows::pool_count > 0 && set.moves(b) && !is_finite(set.v_next[b]));
  });
  world.each([&](auto& set, auto s) {
    for (const Index b : set.active())
      if (is_lost || !set.moves(b) || !is_finite(set.v_next[b])) std::get<s>(paths).back(set.state(), b);
  });
  if constexpr (Rows::pool_count > 0) {
    if (!is_lost) return;
    const bool is_sound = has_finite_forces(world, integrator);
    if (is_sound) {
      linearize(world, laws, rows);
      report.status =
          contradiction(world, rows, equalities) > 1e-3 * way ? Status::infeasible : Status::max_iterations;
    } else {
      report.status = Status::quarantined;
    }
    world.each([&](auto& set, auto) {
      using Velocity = typename std::remove_cvref_t<decltype(set)>::Velocity;
      set.v_next = set.velocity();
      for (const Index b : set.active())
        if (!is_sound && set.moves(b))
          set.v_next[b] = Velocity::Constant(std::numeric_limits<typename Velocity::Scalar>::quiet_NaN());
    });
    each_pool(rows, [](auto, auto& pool) {
      for (auto& x : pool.lambda) x.setZero();
    });
  }
}

}  // namespace delassus::inner
