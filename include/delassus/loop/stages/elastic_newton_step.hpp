/// A whole step of deformable bodies by Newton's method: for `FullNewton`.
#pragma once

#include <delassus/bodies/inner/slope_search.hpp>
#include <delassus/bodies/world.hpp>
#include <delassus/solvers/solve_report.hpp>

#include <algorithm>
#include <cmath>
#include <limits>
#include <tuple>
#include <vector>

namespace delassus {

/// With w the mean velocity of the step,
///
///   M (w − v) = θ h f(q ⊕ θ h w),   v₊ = v + (w − v)/θ,   q₊ = q ⊕ h w,
///
/// θ = 1 implicit Euler, θ = ½ the midpoint rule. Newton's method in w with A = M + (θ h)² K at q ⊕ θ h w,
/// and a search along each of its steps by the slope. Where K is not the whole derivative of f, as that of a
/// rod, it converges linearly.
template <class World, class Laws, class Rows>
class ElasticNewtonStep;

template <class... Sets, class Laws, class Rows>
class ElasticNewtonStep<World<Sets...>, Laws, Rows> {
  static_assert(Rows::pool_count == 0,
                "delassus: FullNewton moves bodies without joints; take the laws out, or use "
                "ImplicitEuler");

 public:
  using World = delassus::World<Sets...>;

  /// Leaves v₊ in v_next; q and v as they were.
  template <class I>
  SolveReport solve(World& world, const Laws&, Rows&, const I& integrator, double h) {
    SolveReport report{.ended_by = "Newton"};
    world.each([&](auto& set, auto s) {
      report.status =
          worse(report.status, std::get<s>(sets_).solve(set, integrator, h, report.factorizations));
    });
    return report;
  }
  void memory(auto&) {}

 private:
  template <class Set>
  struct One {
    using Velocity = typename Set::Velocity;
    using T = typename Set::Scalar;
    std::vector<Velocity> v, w, trial, residual, step;

    template <class I>
    Status solve(Set& set, const I& integrator, double h, int& factorizations) {
      const double theta = integrator.theta;
      const double ahead = theta * h;
      v = w = trial = set.velocity();
      for (auto* array : {&residual, &step}) array->resize(v.size());
      set.shift(0);  // sets the places aside
      Status status = Status::max_iterations;
      double last = 0;
      for (int k = 0; k < integrator.max_iterations && status == Status::max_iterations; ++k) {
        look(set, w, ahead, {.mass = 1, .stiffness = ahead * ahead});
        ++factorizations;
        step = residual;
        set.solve(step);
        const double change = inner::largest(set, step);
        const double size = std::max(inner::largest(set, w), inner::largest(set, v));
        if (!std::isfinite(change + size)) return give_up(set);
        const bool is_near = change <= 1e-7 * size;  // slopes are rounding there: no search
        const double s =
            is_near ? 1 : inner::slope_search(1, inner::product(set, residual, step), [&](double share) {
              go(set, share);
              look(set, trial, ahead, {.mass = 1});
              return inner::product(set, residual, step);
            });
        go(set, s);
        w = trial;
        if (s == 1 && change <= integrator.tolerance * size)
          status = Status::converged;
        else if (k > 0 && change >= last && is_near)
          status = Status::stalled;
        last = change;
      }
      finish(set);
      for (const Index b : set.active()) {
        set.v_free[b] = set.v_next[b] = v[b];
        if (set.moves(b)) set.v_free[b] = set.v_next[b] = v[b] + T(1 / theta) * Velocity(w[b] - v[b]);
      }
      return status;
    }

    /// trial ← w + s step.
    void go(const Set& set, double s) {
      for (const Index b : set.active())
        if (set.moves(b)) trial[b] = w[b] + T(s) * step[b];
    }
    void finish(Set& set) {
      set.restore();
      set.velocity() = v;
    }
    /// There is no step: the bodies stay where they are.
    Status give_up(Set& set) {
      finish(set);
      for (const Index b : set.active()) {
        set.v_free[b] = set.v_next[b] = v[b];
        if (set.moves(b)) set.v_next[b].setConstant(std::numeric_limits<T>::quiet_NaN());
      }
      return Status::quarantined;
    }

    /// residual ← θ h f(q ⊕ θ h u) − M (u − v), M of the start, where impulses act; K and A of q ⊕ θ h u
    /// made.
    void look(Set& set, const std::vector<Velocity>& u, double ahead, SystemScale scale) {
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
    }
  };

  std::tuple<One<Sets>...> sets_;
};

}  // namespace delassus
