#include "allocations/count_allocations.hpp"

#include "allocations/allocation_scenes.hpp"

#include <delassus/collision/with_filter.hpp>

TEST_CASE("a warm step of ten jointed boxes with contacts allocates nothing") {
  REQUIRE(allocations_of_jointed_stack(NativeCollision{}) == 0);
  REQUIRE(allocations_of_jointed_stack(WithFilter{NativeCollision{}}) == 0);
}

TEST_CASE("a warm step of balls that bounce, land and part allocates nothing") {
  AnimationLoop loop{World{RigidBodies{}}, Constraints{Contact{Restitution{Coulomb{.friction = 0.5}, 0.999}}}};
  auto& set = rigid_bodies(loop);
  set.add_fixed(HalfSpace{});
  std::vector<RigidBodies::Handle> balls;
  for (int i = 0; i < 20; ++i) balls.push_back(set.add({.position = {0.5 * i, 0, 1}, .mass = 1.0, .shape = Sphere{0.1}}));
  for (int n = 0; n < 60; ++n) loop.step(1.0 / 60);  // all land at once, so that later there are never more contacts
  for (int i = 0; i < 20; ++i) set.set_velocity(balls[i], {0, 0, 0.3 * i});
  CHECK(allocations_of(loop, 1500, 1500) == 0);
}

TEST_CASE("a warm step of a chain of joints allocates nothing") {
  AnimationLoop loop{World{RigidBodies{}}, Constraints{BallJoint{}, DistanceJoint{}}};
  auto& set = rigid_bodies(loop);
  RigidBodies::Handle last;
  for (int i = 0; i < 10; ++i) {
    const auto link = set.add({.position = {i + 0.5, 0, 0}, .mass = 1.0, .shape = Capsule{0.1, 0.6}});
    if (i == 0) loop.add(BallJoint::Item{anchor(set, link, {-0.5, 0, 0}), world_anchor({0, 0, 0})});
    else loop.add(BallJoint::Item{anchor(set, link, {-0.5, 0, 0}), anchor(set, last, {0.5, 0, 0})});
    last = link;
  }
  loop.add(DistanceJoint::Item{anchor(set, last), world_anchor({5, 0, -5}), 6.0, 100.0, 1.0});
  REQUIRE(allocations_of(loop, 100, 1000) == 0);
}

TEST_CASE("a warm step of particles coupled by springs allocates nothing under implicit Euler") {
  AnimationLoop loop{World{Particles{}}, Constraints{DistanceJoint{}}, ImplicitEuler{}};
  auto& set = rigid_bodies(loop);
  std::vector<Particles::Handle> beads;
  for (int i = 0; i < 10; ++i) {
    beads.push_back(set.add({.position = {0.1 * i, 0, 0}, .mass = 0.1}));
    if (i > 0) set.add_spring(beads[i], beads[i - 1], 500);
  }
  loop.add(DistanceJoint::Item{anchor(set, beads[0]), world_anchor({0, 0, 1}), 1.0});
  loop.add(DistanceJoint::Item{anchor(set, beads[9]), world_anchor({1, 0, 1}), 1.0});
  REQUIRE(allocations_of(loop, 100, 1000) == 0);
}

TEST_CASE("a warm step of bodies that slide and roll allocates nothing under the midpoint rule, with several looks") {
  AnimationLoop loop{World{RigidBodies{}}, Constraints{Contact{Coulomb{.friction = 0.5}}}, ImplicitMidpoint{.looks = 2}};
  auto& set = rigid_bodies(loop);
  set.add_fixed(HalfSpace{});
  for (int i = 0; i < 5; ++i) {
    set.add({.position = {i * 1., 0, 0.1}, .velocity = {0, 1, 0}, .angular_velocity = {1, 0, 0}, .mass = 1.0, .shape = Ellipsoid{0.2, 0.15, 0.1}});
    set.add({.position = {i * 1., 0, 0.4}, .mass = 1.0, .shape = Box{0.2, 0.2, 0.2}});
  }
  REQUIRE(allocations_of(loop, 1000, 1000) == 0);
}
