#include <delassus/solvers/inner/newton_stage.hpp>

#include "newton_tests.hpp"
#include "towers.hpp"

#include <algorithm>
#include <limits>
#include <vector>

using namespace newton_tests;

namespace {

/// Boxes of 1 kg on each other, the top one of `top` kg, each at most `off` metres off its place.
template <class Solver>
auto leaning_stack(int count, double top, Solver solver, double off = 0.04) {
  AnimationLoop loop{World{RigidBodies{}}, Constraints{Contact{Coulomb{.friction = 0.5}}}, std::move(solver)};
  auto& set = rigid_bodies(loop);
  set.add_fixed(HalfSpace{});
  for (int k = 0; k < count; ++k)
    set.add({.position = {off * std::sin(7.0 * k), off * std::cos(5.0 * k), 0.5 + k},
             .mass = k + 1 == count ? top : 1.0,
             .shape = Box{1, 1, 1}});
  return loop;
}

/// The same bits in all impulses.
template <class Problem>
bool are_equal(const Problem& a, const Problem& b) {
  bool equal = true;
  for_each_index<Problem::Rows::pool_count>([&](auto p) {
    const auto &x = a.rows.template pool<p>().lambda, &y = b.rows.template pool<p>().lambda;
    equal = equal && std::equal(x.begin(), x.end(), y.begin(), y.end());
  });
  return equal;
}

}  // namespace

// With sweeps alone two thirds of these steps run out of 4000 sweeps.
TEST_CASE("thirty boxes, the top one of 100 kg, stand under the default solver and every step converges") {
  auto loop = leaning_stack(30, 100, AcceleratedGaussSeidel{});
  const Warm seen = run(loop, 120);
  CHECK(seen.unconverged == 0);
  CHECK(seen.most > 0);
  auto swept = leaning_stack(30, 100, AcceleratedSweeps{.max_iterations = 500});
  CHECK(run(swept, 3).unconverged == 3);
}

// What rests under a heavy top carries impulses 1e6 times those that sweeps have found when the stage opens. Cold counts are those
// that are asked of Newton's method alone, 12 and at 1e8 20; warm ones 2 at the median, and these scenes have theirs in every third step at most.
TEST_CASE("under the default solver cold stacks and mass ratios take a few factorizations and no step is left unconverged") {
  struct Case {
    int count;
    double top, tolerance;
    int most;
  };
  for (const Case& c : {Case{10, 1, 1e-8, 12}, Case{100, 1, 1e-8, 12}, Case{2, 1e6, 1e-8, 12}, Case{12, 1e6, 1e-8, 12},
                        Case{30, 1e4, 1e-8, 12}, Case{2, 1e8, 1e-7, 20}}) {
    CAPTURE(c.count, c.top);
    auto loop = leaning_stack(c.count, c.top, AcceleratedGaussSeidel{.tolerance = c.tolerance}, 1e-3);
    const StepReport first = loop.step(h);
    CHECK(first.status == Status::converged);
    CHECK(loop.island_reports()[0].factorizations > 0);
    CHECK(loop.island_reports()[0].factorizations <= c.most);
    std::vector<int> counts;
    for (int n = 0; n < 60; ++n) {
      CHECK(loop.step(h).status == Status::converged);
      counts.push_back(loop.island_reports()[0].factorizations);
    }
    std::sort(counts.begin(), counts.end());
    CHECK(counts[counts.size() / 2] <= (c.top > 1e7 ? 4 : 2));
  }
}

// Momentum alone takes some 14 sweeps a step here. The stage may double what a step costs at worst, and opens in a step of four at most.
TEST_CASE("where sweeps soon end a solve the stage stays closed") {
  AnimationLoop loop{World{RigidBodies{}}, Constraints{Contact{Coulomb{.friction = 0.5}}}};
  auto& set = rigid_bodies(loop);
  set.add_fixed(HalfSpace{});
  for (int row = 0; row < 8; ++row)
    for (int k = 0; k < 8 - row; ++k)
      set.add({.position = {1.05 * k + 0.525 * row, 0, 0.5 + row}, .mass = 1, .shape = Box{1, 1, 1}});
  int factorizations = 0;
  for (int n = 0; n < 100; ++n) {
    CHECK(loop.step(h).status == Status::converged);
    for (const SolveReport& r : loop.island_reports()) factorizations += r.factorizations;
  }
  CHECK(factorizations <= 100);
}

TEST_CASE("an answer of the stage does not end a solve before the sweeps that are asked at least") {
  auto loop = leaning_stack(10, 100, AcceleratedGaussSeidel{.min_iterations = 150});
  const StepReport report = loop.step(1.0 / 60);
  CHECK(report.status == Status::converged);
  CHECK(report.sweeps >= 150);
  CHECK(loop.island_reports()[0].factorizations > 0);
}

// Residuals of 1e-12 of velocities of order 1 m/s, and the error constant of the problem, for which 1e-9 leaves a thousand.
TEST_CASE("the stage is named, and what it finds is what Newton's method finds alone") {
  auto loop = leaning_stack(10, 100, AcceleratedSweeps{.max_iterations = 1});
  auto chained = problem_of(loop), newton = chained;
  const SolveReport r = solve(chained, AcceleratedGaussSeidel{.tolerance = 1e-12});
  REQUIRE(r.status == Status::converged);
  CHECK(r.ended_by == std::string("newton"));
  CHECK(r.factorizations > 0);
  CHECK(r.sweeps < 400);
  REQUIRE(solve(newton, ProximalNewton{.tolerance = 1e-12}).status == Status::converged);
  CHECK(apart(chained, newton) <= 1e-9);
}

TEST_CASE("the chain with Newton's method gives the same bits for the same input") {
  auto loop = leaning_stack(12, 50, AcceleratedSweeps{.max_iterations = 1});
  auto a = problem_of(loop), b = a;
  const SolveReport first = solve(a, AcceleratedGaussSeidel{.tolerance = 1e-10}),
                    second = solve(b, AcceleratedGaussSeidel{.tolerance = 1e-10});
  CHECK(first.factorizations > 0);
  CHECK(first.factorizations == second.factorizations);
  CHECK(first.sweeps == second.sweeps);
  CHECK(are_equal(a, b));
}

// A tolerance that nothing meets: whatever the stage tried, the rows have what the report measured, and more
// sweeps, in the middle of which the stage opens, leave no larger error.
TEST_CASE("what the stage does not solve it does not spoil") {
  auto loop = leaning_stack(6, 1, AcceleratedSweeps{.max_iterations = 1});
  const auto cold = problem_of(loop);
  double last = std::numeric_limits<double>::infinity();
  for (const int limit : {10, 19, 21, 30, 60, 100, 200}) {
    CAPTURE(limit);
    auto p = cold;
    const SolveReport r = solve(p, AcceleratedGaussSeidel{.tolerance = 0, .max_iterations = limit});
    // λ went back to the saved iterate through W: the measure is the same number to rounding.
    CHECK(error(p) <= std::max(2 * r.measure.residual, r.measure.floor));
    CHECK(r.measure.residual <= std::max(last, r.measure.floor));
    last = r.measure.residual;
  }
}

TEST_CASE("where Newton's method cannot act the default sweeps to the same bits as sweeps alone") {
  AnimationLoop loop{World{Particles{}}, Constraints{DistanceJoint{}}, ImplicitEuler{},
                     AcceleratedSweeps{.max_iterations = 1}};
  auto& dust = bodies<Particles>(loop.world());
  std::vector<Particles::Handle> beads;
  for (int k = 0; k < 30; ++k) {
    beads.push_back(dust.add({.position = {0, 0, -0.1 * k}, .mass = k % 2 ? 0.1 : 10.0}));
    if (k == 0) continue;
    dust.add_spring(beads[k - 1], beads[k], 500);
    loop.add(DistanceJoint::Item{anchor(dust, beads[k - 1]), anchor(dust, beads[k]), 0.1});
  }
  loop.add(DistanceJoint::Item{anchor(dust, beads[0]), world_anchor({0, 0, 1}), 1.0});
  auto p = problem_of(loop), q = p;
  const SolveReport chained = solve(p, AcceleratedGaussSeidel{.tolerance = 1e-9}),
                    swept = solve(q, AcceleratedSweeps{.tolerance = 1e-9});
  CHECK(swept.sweeps > 40);  // long enough for the stage to have opened
  CHECK(chained.sweeps == swept.sweeps);
  CHECK(chained.factorizations == 0);
  CHECK(are_equal(p, q));
}

// The last change of a sweep is nothing that a factorization has.
TEST_CASE("a chain that stops by the last change has no such stage") {
  auto loop = leaning_stack(10, 1, AcceleratedSweeps{.max_iterations = 1});
  auto p = problem_of(loop);
  const AcceleratedGaussSeidel solver{.tolerance = 1e-12, .max_iterations = 300, .criterion = Criterion::last_change};
  const SolveReport r = solve(p, solver);
  CHECK(r.sweeps > 40);
  CHECK(r.factorizations == 0);
}
