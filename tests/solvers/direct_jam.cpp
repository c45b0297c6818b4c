// The direct path where joints press contacts on each other from several sides.
#include "catch.hpp"
#include "knotted_rope.hpp"

#include <delassus/solvers/with_deadline.hpp>

namespace direct_jam_tests {

using namespace knotted_rope;

// Sweeps alone leave 116 steps of the same time at up to 1e-3. Of the most wedged steps one or two of 768 may run out of sweeps there,
// with other last bits other ones.
TEST_CASE("nearly every step of a rope with a tight knot converges in a thousand sweeps and Newton's method") {
  auto loop = rope(DirectGaussSeidel{.tolerance = 1e-6, .max_iterations = 1000});
  int helped = 0, unconverged = 0;
  for (int n = 0; n < 2 * tight; ++n) {
    const StepReport report = sink(loop);
    if (n < tight) continue;
    unconverged += report.status != Status::converged;
    CHECK(report.residual <= 1e-3);
    helped += loop.island_reports()[0].factorizations > 1;
  }
  CAPTURE(helped);
  CHECK(unconverged <= 3);
  CHECK(helped > 100);
}

// A tick of the clock per look: what looks once more after the deadline moves it once more.
TEST_CASE(
    "in the midst of Newton's method on what joints leave of contacts too a solve ends at its deadline") {
  double time = 0;
  auto loop = rope(WithDeadline{DirectGaussSeidel{.tolerance = 1e-10}, 1e9, ScriptedClock{&time, 1}});
  for (int n = 0; n < tight; ++n) sink(loop);
  int late = 0;
  for (int n = 0; n < 300; ++n) {
    const double budget = 430 + n % 30;  // 400 are for the sweeps before Newton's method
    loop.template policy<role::Solver>().budget = budget;
    time = 0;
    sink(loop);
    const SolveReport& solve = loop.island_reports()[0];
    CAPTURE(n, solve.sweeps, solve.factorizations);
    REQUIRE(time <= budget + 1);
    late += solve.status == Status::deadline && solve.factorizations > 1;
  }
  CHECK(late > 10);
}

}  // namespace direct_jam_tests
