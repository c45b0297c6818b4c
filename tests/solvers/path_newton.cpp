#include <delassus/solvers/path_newton.hpp>

#include "catch.hpp"
#include "path_tests.hpp"
#include "scenes.hpp"

namespace path_newton_tests {

using namespace scenes;
using namespace path_tests;
using cold_problems::tower;

TEST_CASE("the path of smoothed laws leads to Coulomb's law without a sweep, in body space") {
  for (const double heavy : {1.0, 1e3}) {
    auto p = tower({1, 1, heavy}, 0.1, 0.01);
    check_solved(p, solve(p, path_alone));
  }
}

// Four contacts a face are three too many for each λ to be unique; what moves is. Both errors of 1e-7 are
// relative to velocities of 0.1 m/s, and three boxes pass them on with a condition of some ten.
TEST_CASE("the motion at the end of the path is that of the sweeps") {
  auto p = tower({1, 1, 1}, 0.1, 0.01), swept = p;
  REQUIRE(solve(p, path_alone).status == Status::converged);
  REQUIRE(solve(swept, AcceleratedGaussSeidel{.tolerance = 1e-10}).status == Status::converged);
  const auto& contacts = p.rows.pool<0>();
  for (Index i = 0; i < Index(contacts.lambda.size()); ++i) {
    const double apart = (p.W.residual<0>(p.rows, i) - swept.W.residual<0>(swept.rows, i)).norm();
    REQUIRE(apart <= 1e-6);
  }
}

TEST_CASE("where the path is not let to its end, sweeps go on from its best impulses") {
  auto p = tower({1, 1, 1}, 0.1, 0.01);
  const SolveReport r = solve(p, PathNewton{.tolerance = 1e-8, .max_iterations = 15});
  REQUIRE(r.status == Status::converged);
  REQUIRE(r.sweeps > 0);
  REQUIRE(r.factorizations <= 15);
  REQUIRE(error(p) <= 1e-8);
}

TEST_CASE("where a contact's own matrix is singular to working precision the path ends, and what it found is kept") {
  AnimationLoop loop{World{RigidBodies{}}, Constraints{Contact{Coulomb{.friction = 0.5}}},
                     GaussSeidel{.max_iterations = 0, .min_iterations = 0}};
  add_stack(rigid_bodies(loop), 50, Box{1, 1, 1});
  loop.step(1.0 / 60);
  auto p = loop.problem();
  const SolveReport r = solve(p, PathNewton{.tolerance = 1e-14, .max_sweeps = 0});
  REQUIRE(r.factorizations > 0);
  REQUIRE(r.measure.residual < 1e-9);
}

TEST_CASE("what is solved already is not touched by the path, and a limit of none leaves λ as it is") {
  auto p = tower({1, 1}, 0.1, 0.01);
  REQUIRE(solve(p, AcceleratedGaussSeidel{.tolerance = 1e-9}).status == Status::converged);
  const auto before = p.rows.pool<0>().lambda;
  REQUIRE(solve(p, PathNewton{.tolerance = 1e-6}).factorizations == 0);
  REQUIRE(p.rows.pool<0>().lambda == before);
  const SolveReport none = solve(p, PathNewton{.tolerance = 0, .max_iterations = 0, .max_sweeps = 0});
  REQUIRE(none.factorizations == 0);
  for (std::size_t i = 0; i < before.size(); ++i)  // W is told of λ there and back
    REQUIRE((p.rows.pool<0>().lambda[i] - before[i]).norm() <= 1e-12);
}

TEST_CASE("a number of PathNewton that cannot be is refused in one sentence") {
  REQUIRE_THROWS_WITH(PathNewton{.tolerance = -1}.check(), Catch::Contains("PathNewton: tolerance -1"));
  REQUIRE_THROWS_WITH(PathNewton{.max_iterations = -1}.check(), Catch::Contains("max_iterations -1"));
  REQUIRE_THROWS_WITH(PathNewton{.max_sweeps = -1}.check(), Catch::Contains("max_sweeps -1"));
}

}  // namespace path_newton_tests
