// Where springs couple the bodies.
#include "newton_tests.hpp"

namespace proximal_newton_coupled_tests {

using namespace newton_tests;

// Springs under implicit Euler couple the particles: A has no block of one of them, and the report says who
// did the work.
TEST_CASE("particles coupled by springs are swept") {
  AnimationLoop loop{World{Particles{}}, Constraints{DistanceJoint{}}, ImplicitEuler{}, ProximalNewton{}};
  auto& dust = bodies<Particles>(loop.world());
  const auto a = dust.add({.position = {0, 0, 0}, .mass = 1.0}),
             b = dust.add({.position = {0.1, 0, 0}, .mass = 1.0});
  dust.add_spring(a, b, 500);
  loop.add(DistanceJoint::Item{anchor(dust, a), world_anchor({0, 0, 1}), 1.0});
  REQUIRE(loop.step(h).status == Status::converged);
  REQUIRE(loop.island_reports().size() == 1);
  CHECK(loop.island_reports()[0].factorizations == 0);
  CHECK(loop.island_reports()[0].sweeps > 0);
}

}  // namespace proximal_newton_coupled_tests
