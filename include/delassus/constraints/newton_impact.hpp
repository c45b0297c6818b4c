/// Newton's impact law in a step: restitution of rows that close.
#pragma once

#include <delassus/constraints/constraints.hpp>
#include <delassus/core/array.hpp>
#include <delassus/core/owning_array.hpp>
#include <delassus/rows/rate.hpp>
#include <delassus/rows/row_kind.hpp>
#include <delassus/rows/row_system.hpp>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <type_traits>
#include <utility>

namespace delassus {
namespace inner {

template <class Law, class Item>
double restitution_of(const Law& law, const Item& item) {
  if constexpr (refines<Law>(refine::restitution)) return law.restitution(item);
  else return 0;
}

}  // namespace inner

/// A row with a bound (`RowKind::lower` or `upper`) that closes within the step with u⁻ < 0 gets the stronger of e u⁻ and the push-out speed, never their sum.
/// Taking u⁻ at the start of the step makes e = 1 keep ½ v² + g x − ½ h g v, the energy that symplectic Euler itself
/// keeps. `bounce` takes what this added to the bias, by pool and row.
template <class World, class Laws, class Rows, class T>
void add_restitution(const World& world, const Laws& laws, Rows& rows, double h, OwningArray<Array<T>>& bounce) {
  bounce.resize(std::size_t(Rows::pool_count));
  each_pool(laws, [&](auto p, const auto& constraints) {
    auto& pool = rows.template pool<p>();
    using Law = std::remove_cvref_t<decltype(constraints.law)>;
    Array<T>& added = bounce[std::size_t(p)];
    added.assign(std::size_t(Law::rows) * std::size_t(pool.items()), T(0));
    if constexpr (refines<Law>(refine::restitution)) {
      constexpr auto kinds = row_kinds<Law>();
      for (Index i = 0; i < pool.items(); ++i) {
        const double restitution = inner::restitution_of(constraints.law, constraints.item(i));
        if (!(restitution > 0)) continue;
        const auto free = inner::rate(pool, i, world, [](const auto& set) -> const auto& { return set.v_free; });
        const auto start = inner::rate(pool, i, world, [](const auto& set) -> const auto& { return set.velocity(); });
        for (int k = 0; k < Law::rows; ++k) {
          if (kinds[k] != RowKind::lower && kinds[k] != RowKind::upper) continue;
          if (pool.stiffness[i][k] > 0 || pool.damping[i][k] > 0) continue;
          const double sign = kinds[k] == RowKind::lower ? 1 : -1, phi = sign * double(pool.phi[i][k]);
          const double closing = sign * double(start[k]), plain = sign * double(pool.bias[i][k]);
          if (!(phi + h * sign * double(free[k]) < 0 && closing < 0)) continue;
          const double bias = std::min(phi < 0 ? plain : 0.0, restitution * closing);
          added[std::size_t(Law::rows * i + k)] = T(sign * (bias - plain));
          pool.bias[i][k] = T(sign * bias);
          pool.d[i][k] = free[k] + pool.bias[i][k];
        }
      }
    }
  });
}

/// Newton's restitution on several contacts with friction can add energy. Where it did, λ becomes λ_c + s (λ_N − λ_c):
/// λ_N the solution with restitution, λ_c the one without, s the largest number in [0, 1] for which the impulses add no
/// more energy than those of λ_c do. Both lie in the cone, which is convex, so λ does. An island is a solver's.
template <class Island>
class EnergyGuard {
  using T = typename Island::T;

 public:
  EnergyGuard(Island& island, const OwningArray<Array<T>>& bounce, Array<T>& newton, Array<T>& newton_velocity)
      : island_(island), bounce_(bounce), newton_(newton), velocity_(newton_velocity) {}

  /// After a solve that converged; `solve_again` solves anew, from the λ there is.
  template <class Solve>
  void act(const Solve& solve_again) {
    if (!has_bounced() || !(energy() > 0)) return;
    take_bounce_away();
    solve_again();
    shed();
    const double s = share();
    T next[most_rows];
    std::size_t at = 0;
    for (const auto& span : island_)
      for (const Index i : span) {
        const T* lambda = island_.impulse(span, i);
        for (int k = 0; k < span.pool->rows; ++k, ++at) next[k] = lambda[k] + T(s) * (newton_[at] - lambda[k]);
        island_.assign(span, i, next);
      }
  }

 private:
  static const T* bias(const auto& span, Index i) { return span.pool->bias + std::ptrdiff_t(span.pool->rows) * i; }

  bool has_bounced() const {
    for (const auto& span : island_) {
      const int R = span.pool->rows;
      const T* added = bounce_[std::size_t(span.pool->pool)].data();
      for (const Index i : span)
        for (int k = 0; k < R; ++k)
          if (added[std::ptrdiff_t(R) * i + k] != T(0)) return true;
    }
    return false;
  }

  /// The energy that the impulses give the bodies, J: Σ ½ λ·(u_free + u⁺), u without bias.
  double energy() const {
    double sum = 0;
    T u[most_rows];
    for (const auto& span : island_)
      for (const Index i : span) {
        island_.velocity(span, i, u);
        const T *lambda = island_.impulse(span, i), *d = island_.free_of_impulses(span, i), *b = bias(span, i);
        for (int k = 0; k < span.pool->rows; ++k) sum += 0.5 * double(lambda[k]) * double(d[k] + u[k] - b[k] - b[k]);
      }
    return sum;
  }

  /// λ_N is kept with its velocity; bias and d are those without restitution from here on.
  void take_bounce_away() {
    island_.save(newton_);
    velocity_.resize(newton_.size());
    T* u = velocity_.data();
    for (const auto& span : island_)
      for (const Index i : span) {
        const int R = span.pool->rows;
        island_.velocity(span, i, u);
        for (int k = 0; k < R; ++k) u[k] -= bias(span, i)[k];
        u += R;
      }
    for (const auto& span : island_)
      for (const Index i : span) {
        const std::ptrdiff_t at = std::ptrdiff_t(span.pool->rows) * i;
        const T* added = bounce_[std::size_t(span.pool->pool)].data() + at;
        for (int k = 0; k < span.pool->rows; ++k) span.pool->bias[at + k] -= added[k], span.pool->d[at + k] -= added[k];
      }
  }

  /// A solution without restitution gives at most −Σ λ·bias, the work of the push-out. Where the sweeps ran out before that
  /// holds, λ ← s λ, s the largest number in [0, 1] for which it does; a cone holds s λ too.
  void shed() {
    double push = 0, free = 0, curvature = 0;  // E(s) = free s + ½ curvature s²
    T u[most_rows];
    for (const auto& span : island_)
      for (const Index i : span) {
        island_.velocity(span, i, u);
        const T *lambda = island_.impulse(span, i), *d = island_.free_of_impulses(span, i), *b = bias(span, i);
        for (int k = 0; k < span.pool->rows; ++k) {
          push -= double(lambda[k] * b[k]);
          free += double(lambda[k] * (d[k] - b[k]));
          curvature += double(lambda[k] * (u[k] - d[k]));
        }
      }
    const double allowed = std::max(0.0, push);
    if (!(free + 0.5 * curvature > allowed) || !(curvature > 0)) return;
    const double s = std::clamp((std::sqrt(free * free + 2 * curvature * allowed) - free) / curvature, 0.0, 1.0);
    T next[most_rows];
    for (const auto& span : island_)
      for (const Index i : span) {
        const T* lambda = island_.impulse(span, i);
        for (int k = 0; k < span.pool->rows; ++k) next[k] = lambda[k] + T(s - 1) * lambda[k];
        island_.assign(span, i, next);
      }
  }

  /// s, by E(s) = E_c + b s + a s² with δ = λ_N − λ_c, a = ½ δ·Wδ, b = δ·u_c, u_c the velocity after λ_c.
  double share() const {
    double a = 0, b = 0;
    T u[most_rows];
    std::size_t at = 0;
    for (const auto& span : island_)
      for (const Index i : span) {
        island_.velocity(span, i, u);
        const T* lambda = island_.impulse(span, i);
        for (int k = 0; k < span.pool->rows; ++k, ++at) {
          const T velocity = u[k] - bias(span, i)[k], delta = newton_[at] - lambda[k];
          a += 0.5 * double(delta * (velocity_[at] - velocity));
          b += double(delta * velocity);
        }
      }
    const double plain = energy(), room = std::max(0.0, plain) - plain;  // a s² + b s ≤ room
    if (!(a + b > room)) return 1;
    const double root = std::sqrt(std::max(0.0, b * b + 4 * a * room));
    return a > 0 ? std::clamp(b > 0 ? 2 * room / (b + root) : (root - b) / (2 * a), 0.0, 1.0) : 0;
  }

  Island& island_;
  const OwningArray<Array<T>>& bounce_;
  Array<T>&newton_, &velocity_;  ///< λ_N and its velocity without bias
};

/// What laws with `restitution(item)` change: the bias, and a solve that must not add energy.
struct NewtonImpact {
  template <class P>
  struct State {
    using T = typename P::Rows::Scalar;
    OwningArray<Array<T>> bounce;
    Array<T> newton, newton_velocity;
  };

  template <class Base>
  struct stages : Base {
    static void make_bias(auto& step) {
      Base::make_bias(step);
      auto& own = step.template state<NewtonImpact>();
      for (auto* numbers : {&own.newton, &own.newton_velocity}) numbers->reserve(std::size_t(step.rows.row_count()));
      add_restitution(std::as_const(step).world(), step.laws(), step.rows, step.h, own.bounce);
    }
    static void solve_island(auto& step, auto& island) {
      Base::solve_island(step, island);
      auto& own = step.template state<NewtonImpact>();
      const auto report = step.reports[island.island()];
      EnergyGuard(island, own.bounce, own.newton, own.newton_velocity).act([&] { Base::solve_island(step, island); });
      step.reports[island.island()] = report;
    }
  };
};

}  // namespace delassus
