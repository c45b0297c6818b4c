#include "scenes.hpp"

#include "catch.hpp"

namespace accelerated_gauss_seidel_tests {

using namespace scenes;

namespace {

constexpr double mu = 0.5;

auto stack_problem(int count) {
  AnimationLoop loop{World{RigidBodies{}}, Constraints{Contact{Coulomb{.friction = mu}}},
                     AcceleratedGaussSeidel{.max_iterations = 1}};
  add_stack(rigid_bodies(loop), count, Box{1, 1, 1});
  loop.step(1.0 / 60);
  auto p = loop.problem();
  for (auto& x : p.rows.pool<0>().lambda) x.setZero();
  return p;
}

const auto ten = stack_problem(10);

}  // namespace

// Measured: 20 000 plain sweeps and a few hundred accelerated ones on ten boxes; a tenth is a wide margin.
TEST_CASE("momentum needs less than a tenth of the plain sweeps on ten boxes") {
  auto p = ten, q = ten;
  const SolveReport plain = solve(p, GaussSeidel{.tolerance = 1e-6, .max_iterations = 100000});
  const SolveReport fast = solve(q, AcceleratedGaussSeidel{.tolerance = 1e-6, .max_iterations = 100000});
  REQUIRE(plain.status == Status::converged);
  REQUIRE(fast.status == Status::converged);
  REQUIRE(10 * fast.sweeps < plain.sweeps);
}

TEST_CASE("what momentum converges to meets the law by the plain solver's measure") {
  auto p = ten;
  const SolveReport r = solve(p, AcceleratedGaussSeidel{.tolerance = 1e-9, .max_iterations = 100000});
  REQUIRE(r.status == Status::converged);
  const Measure again = solve(p, GaussSeidel{.max_iterations = 0, .min_iterations = 0}).measure;
  REQUIRE(again.residual <= 1e-9);
}

TEST_CASE("when the sweeps run out the best measured iterate is returned") {
  double best = std::numeric_limits<double>::infinity();
  for (const int limit : {1, 5, 17, 40, 64, 130}) {
    auto p = ten;
    const SolveReport r = solve(p, AcceleratedSweeps{.tolerance = 1e-12, .max_iterations = limit});
    REQUIRE(r.status == Status::max_iterations);
    REQUIRE(r.sweeps == limit);
    const Measure again = solve(p, GaussSeidel{.max_iterations = 0, .min_iterations = 0}).measure;
    // λ went back to the saved iterate through W: the measure is the same number.
    REQUIRE(again.residual == Approx(r.measure.residual).epsilon(1e-12));
    best = std::min(best, again.residual);
  }
  auto p = ten;
  REQUIRE(solve(p, AcceleratedSweeps{.tolerance = 1e-12, .max_iterations = 400}).measure.residual <= best);
}

TEST_CASE("a tolerance below rounding ends at the floor and says stalled") {
  auto p = ten;
  const SolveReport r = solve(p, AcceleratedGaussSeidel{.tolerance = 0, .max_iterations = 100000});
  REQUIRE(r.status == Status::stalled);
  REQUIRE(r.measure.residual <= r.measure.floor);
  REQUIRE(r.sweeps < 100000);
}

TEST_CASE("each of the two solvers refuses a number by its own name") {
  REQUIRE_THROWS_WITH(AcceleratedSweeps{.relaxation = 3}.check(), Catch::StartsWith("delassus: AcceleratedSweeps: relaxation 3 must lie"));
  REQUIRE_THROWS_WITH(AcceleratedSweeps{.tolerance = -1}.check(), Catch::StartsWith("delassus: AcceleratedSweeps: tolerance -1"));
  REQUIRE_THROWS_WITH(AcceleratedGaussSeidel{.max_iterations = -1}.check(), Catch::StartsWith("delassus: AcceleratedGaussSeidel: max_iterations -1"));
}

TEST_CASE("every iterate that momentum returns lies in the cone") {
  for (const int limit : {1, 3, 10, 30, 100}) {
    auto p = ten;
    solve(p, AcceleratedGaussSeidel{.tolerance = 0, .max_iterations = limit});
    for (const Vec3& x : p.rows.pool<0>().lambda) {
      REQUIRE(x[0] >= 0);
      REQUIRE(x.tail<2>().norm() <= mu * x[0] * (1 + 1e-14));
    }
  }
}

}  // namespace accelerated_gauss_seidel_tests
