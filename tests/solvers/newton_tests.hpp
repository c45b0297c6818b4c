/// What the tests of Newton's method share: problems from cold, comparisons with sweeps, counts over steps.
#pragma once

#include <delassus/solvers/proximal_newton.hpp>

#include "cold_problems.hpp"
#include "scenes.hpp"

#include "catch.hpp"

namespace newton_tests {

using namespace cold_problems;
using namespace scenes;

inline constexpr double h = 1.0 / 60;

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
