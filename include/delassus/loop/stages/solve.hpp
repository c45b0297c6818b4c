/// Solve: island by island, each with its own stopping test and status.
#pragma once

#include <delassus/solvers/island_problem.hpp>
#include <delassus/solvers/solve_report.hpp>

#include <algorithm>
#include <cmath>

namespace delassus {

/// Solves one island.
template <class Book, class Rows, class Operator, int pools, class Solver, class Workspace, class Observer>
SolveReport solve_island(Book& book, Rows& rows, Operator& W, const Islands<pools>& islands, Index island,
                         const Solver& solver, Workspace& workspace, double h, Observer& observer) {
  IslandProblem<Book, Rows, Operator, Observer> problem(book, rows, W, islands, island, h, observer);
  return solver.solve(problem, workspace);
}

namespace inner {

/// f(p, i) for every item of an island.
template <int pools, class F>
void each_item(const Islands<pools>& islands, Index island, F&& f) {
  for_each_index<pools>([&](auto p) {
    for (const Index i : islands.items(p, island)) f(p, i);
  });
}

}  // namespace inner

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

/// Joints of the midpoint rule hold H (v + v_next) = f, f what fades across them, and so do the work
/// E = ½ Σ λ·f. A fade is there to take energy. Where bodies turn at ω and α on arms of r, f = h² α ω r/10 and
/// W λ = h (ω² + α) r, so that E of either sign,
///
///   E/(½ λ·W λ) = h α ω/(ω² + α)/10 ≤ h √α/20,
///
/// is below a hundredth while h √α < 0.2. It is above where rows of the middle depend on each other: where they
/// see across a chain drawn straight the other way round than those of the start, f makes grow what it should
/// take. There f is put back into d, and the joints do no work. True: the island has to be solved again.
template <class Rows, class Operator, int pools>
bool withhold_fade(Rows& rows, const Operator& W, const Islands<pools>& islands, Index island,
                   Impulses<Rows>& fade) {
  double work = 0, effort = 0;
  inner::each_item(islands, island, [&](auto p, Index i) {
    work += 0.5 * double(rows.template pool<p>().lambda[i].dot(std::get<p>(fade.pools)[i]));
  });
  if (!(work > 0)) return false;
  inner::each_item(islands, island, [&](auto p, Index i) {
    const auto& pool = rows.template pool<p>();
    effort += 0.5 * double(pool.lambda[i].dot(W.template residual<p>(rows, i) - pool.d[i]));
  });
  if (!(work > 0.01 * effort)) return false;
  inner::each_item(islands, island, [&](auto p, Index i) {
    rows.template pool<p>().d[i] += std::get<p>(fade.pools)[i];
    std::get<p>(fade.pools)[i].setZero();
  });
  return true;
}

/// Every island, one after the other; where a law restitutes, the impulses are checked to add no energy, as
/// are joints of the midpoint rule.
template <class Work, class Solver, class Observer>
void solve_islands(Work& work, const Solver& solver, double h, Observer& observer) {
  work.W.reset(work.rows);
  if constexpr (requires { work.solver.reset(work.rows); }) work.solver.reset(work.rows);
  if constexpr (Work::restitutes)
    for (auto& aside : work.aside) aside.resize_like(work.rows);
  work.reports.resize(work.islands.count());
  for (Index k = 0; k < work.islands.count(); ++k) {
    observer.begin_island(k);
    const auto run = [&] {
      return solve_island(work.book, work.rows, work.W, work.islands, k, solver, work.solver, h, observer);
    };
    work.reports[k] = run();
    if constexpr (Work::at_midpoint)
      if (withhold_fade(work.rows, work.W, work.islands, k, work.fade)) work.reports[k] = run();
    if constexpr (Work::restitutes)
      guard_energy(work.rows, work.W, work.islands, k, work.bounce, work.aside[0], work.aside[1], run);
  }
}

}  // namespace delassus
