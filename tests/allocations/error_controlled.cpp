#include "allocations/count_allocations.hpp"

#include "allocations/allocation_scenes.hpp"

#include <delassus/schemes/error_controlled.hpp>
#include <delassus/steppers/newton_midpoint.hpp>

TEST_CASE("warm steps under error control allocate nothing, repeated ones among them") {
  AnimationLoop loop{World{RigidBodies{}}, Constraints{Contact{Restitution{Coulomb{.friction = 0.5}, 1}}, BallJoint{}}, ImplicitMidpoint{},
                     PositionProjection{}, ErrorControlled{}};
  auto& set = rigid_bodies(loop);
  set.add_fixed(HalfSpace{});
  set.add({.position = {0, 0, 1}, .mass = 1, .shape = Sphere{0.1}});  // it bounces for good
  const auto rod = set.add({.position = {3, 0, 5}, .velocity = {1, 0, 0}, .mass = 0.2, .shape = Box{0.1, 0.1, 2}});
  loop.add(BallJoint::Item{anchor(set, rod, {0, 0, 1}), world_anchor({3, 0, 6})});
  REQUIRE(allocations_of(loop, 200, 200) == 0);
  REQUIRE(error_report(loop).steps > 0);
}

TEST_CASE("nor do those of an integrator that makes its step at once") {
  AnimationLoop loop{World{RigidBodies{}}, Constraints{BallJoint{}}, NewtonMidpoint{}, ErrorControlled{}};
  auto& set = rigid_bodies(loop);
  Anchor end = world_anchor({0, 0, 0});
  for (int k = 0; k < 4; ++k) {
    const auto link = set.add({.position = {0.2 * k + 0.1, 0, 0}, .mass = 1.0, .shape = Box{0.2, 0.05, 0.05}});
    loop.add(BallJoint::Item{end, anchor(set, link, {-0.1, 0, 0})});
    end = anchor(set, link, {0.1, 0, 0});
  }
  REQUIRE(allocations_of(loop, 100, 100) == 0);
}
