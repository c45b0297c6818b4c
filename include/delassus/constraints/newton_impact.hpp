/// Newton's impact law in a step: restitution of rows that close.
#pragma once

#include <delassus/constraints/constraints.hpp>
#include <delassus/rows/impulses.hpp>
#include <delassus/rows/islands.hpp>
#include <delassus/rows/rate.hpp>
#include <delassus/rows/row_kind.hpp>
#include <delassus/rows/row_system.hpp>

#include <algorithm>
#include <cmath>
#include <tuple>
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
/// keeps. `bounce` takes what this added to the bias.
template <class World, class Laws, class Rows>
void add_restitution(const World& world, const Laws& laws, Rows& rows, double h, Impulses<Rows>& bounce) {
  using T = typename Rows::Scalar;
  each_pool(laws, [&](auto p, const auto& constraints) {
    auto& pool = rows.template pool<p>();
    using Law = std::remove_cvref_t<decltype(constraints.law)>;
    constexpr auto kinds = row_kinds<Law>();
    auto& added = std::get<p>(bounce.pools);
    for (Index i = 0; i < pool.items(); ++i) {
      added[i].setZero();
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
        added[i][k] = T(sign * (bias - plain));
        pool.bias[i][k] = T(sign * bias);
        pool.d[i][k] = free[k] + pool.bias[i][k];
      }
    }
  });
}

/// The energy that the impulses of an island give its bodies, J: Σ ½ λ·(u_free + u⁺), u without bias.
template <class Rows, class Operator, int pools>
double impulse_energy(const Rows& rows, const Operator& W, const Islands<pools>& islands, Index island) {
  double sum = 0;
  inner::each_item(islands, island, [&](auto p, Index i) {
    const auto& pool = rows.template pool<p>();
    const auto u = W.template residual<p>(rows, i);
    sum += 0.5 * double(pool.lambda[i].dot(pool.d[i] + u - pool.bias[i] - pool.bias[i]));
  });
  return sum;
}

/// A solution without restitution gives at most −Σ λ·bias, the work of the push-out. Where the sweeps ran out before that
/// holds, λ ← s λ, s the largest number in [0, 1] for which it does; a cone holds s λ too.
template <class Rows, class Operator, int pools>
void shed_energy(Rows& rows, Operator& W, const Islands<pools>& islands, Index island) {
  double push = 0, free = 0, curvature = 0;  // E(s) = free s + ½ curvature s²
  inner::each_item(islands, island, [&](auto p, Index i) {
    const auto& pool = rows.template pool<p>();
    const auto u = (W.template residual<p>(rows, i) - pool.d[i]).eval();
    push -= double(pool.lambda[i].dot(pool.bias[i]));
    free += double(pool.lambda[i].dot(pool.d[i] - pool.bias[i]));
    curvature += double(pool.lambda[i].dot(u));
  });
  const double allowed = std::max(0.0, push);
  if (!(free + 0.5 * curvature > allowed) || !(curvature > 0)) return;
  const double s = std::clamp((std::sqrt(free * free + 2 * curvature * allowed) - free) / curvature, 0.0, 1.0);
  inner::each_item(islands, island, [&](auto p, Index i) {
    auto& pool = rows.template pool<p>();
    const auto change = (typename Rows::Scalar(s - 1) * pool.lambda[i]).eval();
    pool.lambda[i] += change;
    W.template commit<p>(rows, i, change);
  });
}

/// Newton's restitution on several contacts with friction can add energy. Where it did, λ becomes λ_c + s (λ_N − λ_c):
/// λ_N the solution with restitution, λ_c the one without, s the largest number in [0, 1] for which the impulses add no
/// more energy than those of λ_c do. Both lie in the cone, which is convex, so λ does.
template <class Rows, class Operator, int pools, class Solve, class Bounce>
void guard_energy(Rows& rows, Operator& W, const Islands<pools>& islands, Index island, Bounce& bounce,
                  Impulses<Rows>& newton, Impulses<Rows>& newton_velocity, const Solve& solve_again) {
  double bounced = 0;
  inner::each_item(islands, island, [&](auto p, Index i) {
    bounced += double(std::get<p>(bounce.pools)[i].squaredNorm());
  });
  if (bounced == 0 || !(impulse_energy(rows, W, islands, island) > 0)) return;

  inner::each_item(islands, island, [&](auto p, Index i) {
    auto& pool = rows.template pool<p>();
    std::get<p>(newton.pools)[i] = pool.lambda[i];
    std::get<p>(newton_velocity.pools)[i] = W.template residual<p>(rows, i) - pool.bias[i];
    pool.bias[i] -= std::get<p>(bounce.pools)[i];
    pool.d[i] -= std::get<p>(bounce.pools)[i];
  });
  solve_again();
  shed_energy(rows, W, islands, island);
  // E(s) = E_c + b s + a s² with δ = λ_N − λ_c, a = ½ δ·Wδ, b = δ·u_c, u_c the velocity after λ_c.
  double a = 0, b = 0;
  const double plain = impulse_energy(rows, W, islands, island);
  inner::each_item(islands, island, [&](auto p, Index i) {
    const auto& pool = rows.template pool<p>();
    const auto velocity = (W.template residual<p>(rows, i) - pool.bias[i]).eval();
    const auto delta = (std::get<p>(newton.pools)[i] - pool.lambda[i]).eval();
    a += 0.5 * double(delta.dot(std::get<p>(newton_velocity.pools)[i] - velocity));
    b += double(delta.dot(velocity));
  });
  const double room = std::max(0.0, plain) - plain;  // a s² + b s ≤ room
  double s = 1;
  if (a + b > room) {
    const double root = std::sqrt(std::max(0.0, b * b + 4 * a * room));
    s = a > 0 ? std::clamp(b > 0 ? 2 * room / (b + root) : (root - b) / (2 * a), 0.0, 1.0) : 0;
  }
  inner::each_item(islands, island, [&](auto p, Index i) {
    auto& pool = rows.template pool<p>();
    using T = typename Rows::Scalar;
    const auto change = (T(s) * (std::get<p>(newton.pools)[i] - pool.lambda[i])).eval();
    pool.lambda[i] += change;
    W.template commit<p>(rows, i, change);
  });
}

/// What laws with `restitution(item)` change: the bias, and a solve that must not add energy.
struct NewtonImpact {
  template <class P>
  struct State {
    Impulses<typename P::Rows> bounce, newton, newton_velocity;
  };

  template <class Base>
  struct stages : Base {
    static void make_bias(auto& step) {
      Base::make_bias(step);
      auto& own = step.template state<NewtonImpact>();
      for (auto* impulses : {&own.bounce, &own.newton, &own.newton_velocity}) impulses->resize_like(step.rows);
      add_restitution(std::as_const(step).world(), step.laws(), step.rows, step.h, own.bounce);
    }
    static void solve_island(auto& step, Index island, auto& observer) {
      Base::solve_island(step, island, observer);
      auto& own = step.template state<NewtonImpact>();
      const auto report = step.reports[island];
      guard_energy(step.rows, step.W, step.islands, island, own.bounce, own.newton, own.newton_velocity,
                   [&] { Base::solve_island(step, island, observer); });
      step.reports[island] = report;
    }
  };
};

}  // namespace delassus
