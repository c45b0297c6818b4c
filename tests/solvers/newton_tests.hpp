/// What the tests of Newton's method share: problems from cold, comparisons with sweeps, counts over steps.
#pragma once

#include <delassus/solvers/proximal_newton.hpp>

#include "scenes.hpp"

#include "catch.hpp"

namespace newton_tests {

using namespace scenes;

inline constexpr double h = 1.0 / 60;

/// The problem of one step, from cold, of a loop that was set up.
template <class Loop>
auto problem_of(Loop& loop) {
  loop.step(h);
  auto p = loop.problem();
  for_each_index<decltype(p)::Rows::pool_count>([&](auto pool) {
    for (auto& x : p.rows.template pool<pool>().lambda) x.setZero();
  });
  return p;
}

/// The largest |u_i − v_i|, m/s, of the velocities d + W λ of two problems that differ in λ.
template <class Problem>
double apart(const Problem& a, const Problem& b) {
  double most = 0;
  for_each_index<Problem::Rows::pool_count>([&](auto p) {
    for (Index i = 0; i < a.rows.template pool<p>().items(); ++i)
      most = std::max(
          most, double((a.W.template residual<p>(a.rows, i) - b.W.template residual<p>(b.rows, i)).norm()));
  });
  return most;
}

/// Solved tightly by plain sweeps and by Newton's method: the velocities must agree.
template <class Problem>
void compare(const Problem& problem) {
  auto swept = problem, newton = problem;
  REQUIRE(solve(swept, GaussSeidel{.tolerance = 1e-12, .max_iterations = 400000}).status ==
          Status::converged);
  const SolveReport r = solve(newton, ProximalNewton{.tolerance = 1e-12});
  REQUIRE(r.status == Status::converged);
  REQUIRE(r.factorizations > 0);
  CHECK(apart(swept, newton) <= 1e-9);
}

/// Steps a loop and counts: the most factorizations after the first step, and the steps that did not
/// converge.
struct Warm {
  int most = 0, unconverged = 0, sweeps = 0;
};
template <class Loop>
Warm run(Loop& loop, int steps) {
  Warm seen;
  for (int n = 0; n < steps; ++n) {
    const StepReport report = loop.step(h);
    seen.unconverged += report.status != Status::converged;
    seen.sweeps = std::max(seen.sweeps, report.sweeps);
    for (const SolveReport& r : loop.island_reports())
      if (n > 0) seen.most = std::max(seen.most, r.factorizations);
  }
  return seen;
}

}  // namespace newton_tests
