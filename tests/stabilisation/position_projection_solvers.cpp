#include <delassus/delassus.hpp>
#include <delassus/solvers/minimum_norm.hpp>
#include <delassus/solvers/path_newton.hpp>

#include "catch.hpp"

using namespace delassus;

// Friction has no part in displacements: what a solver knows as a cone is a bound there, or is swept.
TEMPLATE_TEST_CASE("position projection lifts a sunk body by any solver", "", PathNewton,
                   MinimumNorm<AcceleratedGaussSeidel>) {
  AnimationLoop loop{World{RigidBodies{}}, Constraints{Contact{Coulomb{}}}, PositionProjection{.rate = 0.2},
                     TestType{}};
  auto& set = bodies<RigidBodies>(loop.world());
  set.add_fixed(HalfSpace{});
  double depth = 0.01;
  const auto ball = set.add({.position = {0, 0, 0.5 - depth}, .mass = 1.0, .shape = Sphere{0.5}});
  for (int n = 0; n < 10; ++n) {
    REQUIRE(loop.step(0.01).status == Status::converged);
    depth *= 0.8;
    REQUIRE(0.5 - set.position(ball).z() == Approx(depth).epsilon(1e-6));  // a solve to 1e-6
  }
}
