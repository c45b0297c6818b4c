#include "newton_tests.hpp"

namespace proximal_newton_tests {

using namespace newton_tests;

namespace {

/// Boxes of these masses on each other, from the ground up.
auto stack_problem(const std::vector<double>& masses) {
  AnimationLoop loop{World{RigidBodies{}}, Constraints{Contact{Coulomb{.friction = 0.5}}},
                     AcceleratedGaussSeidel{.max_iterations = 1}};
  auto& set = rigid_bodies(loop);
  set.add_fixed(HalfSpace{});
  for (std::size_t i = 0; i < masses.size(); ++i)
    set.add({.position = {1e-3 * std::sin(7.0 * i), 1e-3 * std::cos(5.0 * i), 0.5 + i},
             .mass = masses[i],
             .shape = Box{1, 1, 1}});
  return problem_of(loop);
}

}  // namespace

// The velocities of two solutions whose residuals are 1e-12 of velocities of order 1 m/s differ by the error
// constant of the problem times 1e-12; 1e-9 leaves a thousand to it.
TEST_CASE("Newton's method and tight sweeps find the same velocities on a stack") {
  compare(stack_problem({1, 1, 1}));
}
TEST_CASE("Newton's method and tight sweeps find the same velocities on clusters of random contacts") {
  for (const unsigned seed : {1u, 2u, 4u, 5u, 7u}) {
    CAPTURE(seed);
    AnimationLoop loop{World{RigidBodies{}}, Constraints{Contact{Coulomb{.friction = 0.2}}}, GivenContacts{},
                       AcceleratedGaussSeidel{.max_iterations = 1}};
    loop.get<GivenContacts>().points = add_cluster(rigid_bodies(loop), 6, 8, seed, -1e-3);
    compare(problem_of(loop));
  }
}

// Counts of a prototype that solved the same stacks: cold 4, 6, 8, 9, 12 and 15. Sweeps need 1e4 to 1e6 for
// them.
TEST_CASE("cold stacks and mass ratios take a few factorizations and no sweep") {
  const auto with_top = [](int below, double top) {
    std::vector<double> masses(below, 1.0);
    masses.push_back(top);
    return masses;
  };
  struct Case {
    int below;
    double top, tolerance;
    int most;
  };
  for (const Case& c : {Case{9, 1, 1e-8, 4}, Case{29, 1, 1e-8, 6}, Case{99, 1, 1e-8, 8},
                        Case{1, 1e6, 1e-8, 9}, Case{29, 1e4, 1e-8, 12}, Case{1, 1e8, 1e-7, 15}}) {
    CAPTURE(c.below, c.top);
    auto p = stack_problem(with_top(c.below, c.top));
    const SolveReport r = solve(p, ProximalNewton{.tolerance = c.tolerance, .max_sweeps = 0});
    CHECK(r.status == Status::converged);
    CHECK(r.measure.residual <= c.tolerance);
    CHECK(r.factorizations <= c.most);
    CHECK(r.sweeps == 0);
    CHECK(r.ended_by == std::string("newton"));
  }
}

namespace {

auto stack_loop(const std::vector<double>& masses, double tolerance) {
  AnimationLoop loop{World{RigidBodies{}}, Constraints{Contact{Coulomb{.friction = 0.5}}},
                     ProximalNewton{.tolerance = tolerance}};
  auto& set = rigid_bodies(loop);
  set.add_fixed(HalfSpace{});
  for (std::size_t i = 0; i < masses.size(); ++i)
    set.add({.position = {1e-3 * std::sin(7.0 * i), 1e-3 * std::cos(5.0 * i), 0.5 + i},
             .mass = masses[i],
             .shape = Box{1, 1, 1}});
  return loop;
}

}  // namespace

TEST_CASE("ten boxes stand for a minute at 1e-8, every step converged in at most two factorizations") {
  auto loop = stack_loop(std::vector<double>(10, 1.0), 1e-8);
  auto& set = rigid_bodies(loop);
  const Vec3 start = set.position(set.handle(10));
  const Warm seen = run(loop, 3600);
  CHECK(seen.unconverged == 0);
  CHECK(seen.most <= 2);
  CHECK(seen.sweeps == 0);
  CHECK((set.position(set.handle(10)) - start).norm() < 1e-5);
  CHECK(kinetic_energy(set) < 1e-12);
}

TEST_CASE("warm mass ratios take a few factorizations a step") {
  std::vector<double> tower(30, 1.0);
  tower.back() = 1e4;
  auto pair = stack_loop({1, 1e6}, 1e-8), heavy = stack_loop({1, 1e8}, 1e-7), tall = stack_loop(tower, 1e-8);
  const Warm a = run(pair, 600), b = run(heavy, 600), c = run(tall, 100);
  CHECK(a.unconverged + b.unconverged + c.unconverged == 0);
  CHECK(a.most <= 9);
  CHECK(b.most <= 25);
  CHECK(c.most <= 6);
}

TEST_CASE("when it does not converge it says so, and the impulses are those of the residual it reports") {
  for (const int limit : {0, 1, 3}) {
    CAPTURE(limit);
    auto p = stack_problem({1, 1e8, 1, 1e8});
    const SolveReport r =
        solve(p, ProximalNewton{.tolerance = 1e-11, .max_iterations = limit, .max_sweeps = 7});
    REQUIRE(r.status == Status::max_iterations);
    REQUIRE(r.factorizations <= limit);
    REQUIRE(r.sweeps <= 7);
    const Measure again = solve(p, GaussSeidel{.max_iterations = 0, .min_iterations = 0}).measure;
    REQUIRE(again.residual == Approx(r.measure.residual).epsilon(1e-12));
    for (const Vec3& x : p.rows.pool<0>().lambda) REQUIRE(x.tail<2>().norm() <= 0.5 * x[0] * (1 + 1e-14));
  }
}

TEST_CASE("parameters that cannot be right are refused by value") {
  REQUIRE_THROWS_WITH((ProximalNewton{.tolerance = -1}.check()),
                      Catch::Contains("tolerance -1 must be >= 0"));
  REQUIRE_THROWS_WITH((ProximalNewton{.max_sweeps = -2}.check()),
                      Catch::Contains("max_sweeps -2 must be >= 0"));
}

}  // namespace proximal_newton_tests
