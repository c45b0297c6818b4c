#include <delassus/stabilisation/whole_violation.hpp>

#include "catch.hpp"
#include "stabilisation/violated.hpp"

using namespace delassus;

// The row is linear, so first order is all there is: φ + h u⁺ = 0 to a rounding of 0.1 m.
TEST_CASE("the whole violation of a joint is closed within one step") {
  violated::Joint scene(WholeViolation{});
  scene.loop.step(0.01);
  CHECK(scene.set().position(scene.bob).norm() <= 1e-16);
}

// A rod of length 1 m stretched by ε: what is left after a step is of second order in the turn, none here,
// and the row is exact along the rod; a rod that also turns by θ = 0.01 keeps θ²/2.
TEST_CASE("the whole violation of a rod is closed to first order while it turns") {
  AnimationLoop loop{World{Particles{}}, Constraints{DistanceJoint{}}, WholeViolation{}};
  auto& set = bodies<Particles>(loop.world());
  set.gravity.setZero();
  const auto bob = set.add({.position = {1.01, 0, 0}, .velocity = {0, 1, 0}, .mass = 1.0});
  loop.add(DistanceJoint::Item{anchor(set, bob), world_anchor(Vec3::Zero()), 1.0});
  loop.step(0.01);
  CHECK(set.position(bob).norm() - 1 == Approx(0.01 * 0.01 / 2).epsilon(1e-3));
}

TEST_CASE("a body sunk deep is pushed out no faster than the cap, and then stands") {
  violated::Sunk scene(WholeViolation{.max_speed = 0.5}, 0.2);
  const double h = 0.01;
  scene.loop.step(h);
  CHECK(scene.depth() == Approx(0.2 - 0.5 * h).epsilon(1e-12));
  CHECK(scene.exit_speed(h, 100) <= 0.5 * (1 + 1e-12));
  CHECK(std::abs(scene.depth()) <= 1e-3);
}
