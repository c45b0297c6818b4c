// When the stages of a solve look at the error, on errors that are given.
#include <delassus/solvers/accelerated_gauss_seidel.hpp>
#include <delassus/solvers/inner/convergence_monitor.hpp>

#include "catch.hpp"

#include <cmath>
#include <functional>

namespace pursuit_tests {

using namespace delassus;

namespace {

/// An error for each number of sweeps, and who asks for it.
struct Given {
  std::function<double(int)> error;
  int sweeps = 0, measures = 0, saved = 0;

  int row_count() const { return 100; }
  Measure measure() {
    ++measures;
    return {.residual = error(sweeps), .siconos = error(sweeps)};
  }
  void save(int& to) const { to = sweeps; }
  void load(int) {}
  void notify(int, const Measure&) const {}
  static constexpr bool observes_sweeps() { return false; }
  static constexpr bool is_out_of_time() { return false; }
  static constexpr bool is_measure_due() { return false; }
};

/// Sweeps that move as far as the error says, until the monitor ends it.
SolveReport follow(Given& problem, double tolerance) {
  const AcceleratedGaussSeidel solver{.tolerance = tolerance};
  int best = 0;
  inner::ConvergenceMonitor<Given, int> monitor(solver.options(), problem, best);
  REQUIRE(monitor.begin());
  monitor.open("sweeps", 1000);
  do ++problem.sweeps;
  while (monitor.goes_on(std::pow(7 * problem.error(problem.sweeps), 2)));
  return monitor.finish();
}

}  // namespace

// 0.97^k = 1e-5 at k = 378. The movement foretells the error without fault here, and it is looked at
// from 1.5e-5 on: at 364 first, then at most at every sweep.
TEST_CASE("a solve whose movement falls with its error ends in the very sweep that meets the tolerance") {
  Given problem{[](int k) { return std::pow(0.97, k); }};
  const SolveReport r = follow(problem, 1e-5);
  REQUIRE(r.status == Status::converged);
  REQUIRE(r.sweeps == 378);
  // At intervals alone: 4 to sweep 4, 12 to 64, 14 to 364; then 15.
  REQUIRE(problem.measures <= 45);
}

// 0.1^8 is within 2e-8. After the first sweep, after the seventh, and at the end.
TEST_CASE("a solve of eight sweeps looks at its error three times") {
  Given problem{[](int k) { return std::pow(0.1, k); }};
  const SolveReport r = follow(problem, 2e-8);
  REQUIRE(r.status == Status::converged);
  REQUIRE(r.sweeps == 8);
  REQUIRE(problem.measures == 3);
}

// The error dips for one sweep; at intervals of 32 nobody would look there.
TEST_CASE("an error that dips below the tolerance for a single sweep is caught") {
  Given problem{[](int k) { return k == 201 ? 0.5e-3 : 2e-3 + std::pow(0.9, k); }};
  const SolveReport r = follow(problem, 1e-3);
  REQUIRE(r.status == Status::converged);
  REQUIRE(r.sweeps == 201);
}

TEST_CASE("a movement that foretells a large error does not keep the solve from looking") {
  // The sweeps move as far as ever (a row that nothing resists), the error falls.
  Given problem{[](int k) { return std::pow(0.5, k); }};
  const AcceleratedGaussSeidel solver{.tolerance = 1e-9};
  int best = 0;
  inner::ConvergenceMonitor<Given, int> monitor(solver.options(), problem, best);
  REQUIRE(monitor.begin());
  monitor.open("sweeps", 1000);
  do ++problem.sweeps;
  while (monitor.goes_on(1));
  REQUIRE(monitor.finish().status == Status::converged);
  REQUIRE(problem.sweeps <= 30 + 16);  // 2^-30 = 9.3e-10, and twice an interval of 8
}

}  // namespace pursuit_tests
