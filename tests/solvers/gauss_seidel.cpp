#include "scenes.hpp"

#include "catch.hpp"

namespace gauss_seidel_tests {

using namespace scenes;

namespace {

constexpr double mu = 0.5;

/// A stack of `count` boxes in the first step of its fall: the problem that Gauss-Seidel finds hard.
auto stack_problem(int count) {
  AnimationLoop loop{World{RigidBodies{}}, Constraints{Contact{Coulomb{.friction = mu}}},
                     GaussSeidel{.max_iterations = 0, .min_iterations = 0}};
  add_stack(rigid_bodies(loop), count, Box{1, 1, 1});
  loop.step(1.0 / 60);
  return loop.problem();
}

template <class Problem>
int outside_the_cone(const Problem& problem) {
  int count = 0;
  for (const Vec3& x : problem.rows.template pool<0>().lambda)
    count += x.tail<2>().norm() > mu * x[0] * (1 + 1e-14) || x[0] < 0;
  return count;
}

const auto three = stack_problem(3);

}  // namespace

TEST_CASE("the sweeps stop as soon as the residual is within the tolerance") {
  for (const double tolerance : {1e-3, 1e-6, 1e-9}) {
    auto p = three;
    const SolveReport r = solve(p, GaussSeidel{.tolerance = tolerance, .max_iterations = 100000});
    REQUIRE(r.status == Status::converged);
    REQUIRE(r.measure.residual <= tolerance);
  }
}

TEST_CASE("sweeps that run out are a status, and their number is max_iterations") {
  auto p = three;
  const SolveReport r = solve(p, GaussSeidel{.tolerance = 1e-12, .max_iterations = 7});
  REQUIRE(r.status == Status::max_iterations);
  REQUIRE(r.sweeps == 7);
  REQUIRE(r.measure.residual > 1e-12);
}

TEST_CASE("min_iterations sweeps are done even from the solution") {
  auto p = three;
  REQUIRE(solve(p, GaussSeidel{.tolerance = 1e-9, .max_iterations = 100000}).status == Status::converged);
  REQUIRE(solve(p, GaussSeidel{.tolerance = 1e-6, .min_iterations = 0}).sweeps == 0);
  REQUIRE(solve(p, GaussSeidel{.tolerance = 1e-6, .min_iterations = 3}).sweeps == 3);
}

TEST_CASE("relaxation converges to the tolerance and stays in the cone") {
  for (const double omega : {0.3, 0.8, 1.2, 1.6}) {
    auto p = three;
    const SolveReport r = solve(p, GaussSeidel{.tolerance = 1e-8, .max_iterations = 200000, .relaxation = omega});
    CAPTURE(omega);
    REQUIRE(r.status == Status::converged);
    REQUIRE(outside_the_cone(p) == 0);
    auto q = three;
    solve(q, GaussSeidel{.tolerance = 0, .max_iterations = 5, .relaxation = omega});
    REQUIRE(outside_the_cone(q) == 0);
  }
}

TEST_CASE("relaxation outside (0, 2) is refused by value") {
  using delassus::Constraints;
  for (const double omega : {0.0, -1.0, 2.0, 3.0})
    REQUIRE_THROWS_WITH((GaussSeidel{.relaxation = omega}.check()),
                        Catch::Contains("relaxation") && Catch::Contains("must lie in (0, 2)"));
}

TEST_CASE("scale_tolerance multiplies the tolerance by the number of rows") {
  auto p = three;
  const int rows = int(p.rows.row_count());
  const double tolerance = 1e-7;
  const SolveReport r = solve(p, GaussSeidel{.tolerance = tolerance, .max_iterations = 100000, .scale_tolerance = true});
  REQUIRE(r.status == Status::converged);
  REQUIRE(r.measure.residual <= rows * tolerance);
  REQUIRE(r.measure.residual > tolerance);
}

TEST_CASE("all_verified asks every constraint for its own share of the residual") {
  auto p = three;
  const SolveReport r = solve(p, GaussSeidel{.tolerance = 1e-7, .max_iterations = 100000, .all_verified = true});
  REQUIRE(r.status == Status::converged);
  REQUIRE(r.measure.worst <= 1e-7);
  REQUIRE(r.measure.residual > 1e-7);  // their sum may be larger: twelve contacts
  REQUIRE(r.measure.residual <= std::sqrt(12.0) * 1e-7);
}

TEST_CASE("all_verified takes the unscaled tolerance even beside scale_tolerance") {
  auto p = three;
  const SolveReport r = solve(
      p, GaussSeidel{.tolerance = 1e-7, .max_iterations = 100000, .scale_tolerance = true, .all_verified = true});
  REQUIRE(r.measure.worst <= 1e-7);
}

TEST_CASE("the criterion siconos_error stops on Siconos' measure") {
  auto p = three;
  const SolveReport r = solve(p, GaussSeidel{.tolerance = 1e-6, .max_iterations = 100000, .criterion = Criterion::siconos_error});
  REQUIRE(r.status == Status::converged);
  REQUIRE(r.measure.siconos <= 1e-6);
}

TEST_CASE("the criterion last_change stops on the displacement of the last sweep") {
  auto p = three;
  const double tolerance = 1e-9;  // m
  const SolveReport r = solve(p, GaussSeidel{.tolerance = tolerance, .max_iterations = 100000, .criterion = Criterion::last_change});
  REQUIRE(r.status == Status::converged);
  REQUIRE(r.sweeps > 1);
  // Σ |h W_ii Δλ_i| of the next sweep, computed here, is no larger: the sweeps contract.
  auto before = p.rows.pool<0>().lambda;
  solve(p, GaussSeidel{.tolerance = 0, .max_iterations = 1});
  double change = 0;
  for (Index i = 0; i < p.rows.pool<0>().items(); ++i)
    change += p.h * p.W.diagonal<0>(i).trace() / 3 * (p.rows.pool<0>().lambda[i] - before[i]).norm();
  REQUIRE(change <= tolerance);
  REQUIRE(change > 0);
}

TEST_CASE("the last change of every constraint below the tolerance is not yet their sum below it") {
  const double tolerance = 1e-9;  // m
  auto every = three, sum = three;
  const SolveReport a = solve(every, GaussSeidel{.tolerance = tolerance, .max_iterations = 100000, .all_verified = true, .criterion = Criterion::last_change});
  const SolveReport b = solve(sum, GaussSeidel{.tolerance = tolerance, .max_iterations = 100000, .criterion = Criterion::last_change});
  REQUIRE(a.status == Status::converged);
  REQUIRE(a.sweeps < b.sweeps);
  auto before = every.rows.pool<0>().lambda;
  solve(every, GaussSeidel{.tolerance = 0, .max_iterations = 1});
  double worst = 0, all = 0;
  for (Index i = 0; i < every.rows.pool<0>().items(); ++i) {
    const double change =
        every.h * every.W.diagonal<0>(i).trace() / 3 * (every.rows.pool<0>().lambda[i] - before[i]).norm();
    worst = std::max(worst, change);
    all += change;
  }
  REQUIRE(worst <= tolerance);
  REQUIRE(all > tolerance);
}

TEST_CASE("the impulses of a solve do not depend on the scale of time and mass beyond rounding") {
  // d and λ of a problem times 1024: the same sweeps, the same bits times 1024.
  auto p = three, q = three;
  for (auto& d : q.rows.pool<0>().d) d *= 1024;
  const GaussSeidel solver{.tolerance = 1e-6, .max_iterations = 100000};
  const int sweeps = solve(p, solver).sweeps;
  REQUIRE(solve(q, solver).sweeps == sweeps);
  for (Index i = 0; i < p.rows.pool<0>().items(); ++i)
    REQUIRE((1024 * p.rows.pool<0>().lambda[i] - q.rows.pool<0>().lambda[i]).norm() == 0);
}

}  // namespace gauss_seidel_tests
