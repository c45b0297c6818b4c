// Contradictions among contacts and rods, and what only looks like one.
#include "scenes.hpp"

#include "catch.hpp"

namespace infeasible_scenes_tests {

using namespace scenes;

namespace {

constexpr double h = 0.01;

auto loop_of(double tolerance) {
  return AnimationLoop{World{RigidBodies{}}, Constraints{Contact{Coulomb{.friction = 0.5}}, DistanceJoint{}},
                       AcceleratedGaussSeidel{.tolerance = tolerance}};
}

}  // namespace

TEST_CASE("stacks and mass ratios that sweeps do not get through are not called infeasible") {
  for (const double heavy : {1e2, 1e4, 1e6, 1e8}) {
    auto loop = loop_of(1e-6);
    auto& set = rigid_bodies(loop);
    set.add_fixed(HalfSpace{});
    set.add({.position = {0, 0, 0.5}, .mass = 1.0, .shape = Box{1, 1, 1}});
    set.add({.position = {0, 0, 1.5}, .mass = heavy, .shape = Box{1, 1, 1}});
    for (int n = 0; n < 3; ++n) REQUIRE(loop.step(h).status < Status::infeasible);
  }
  auto loop = loop_of(1e-12);
  add_stack(rigid_bodies(loop), 20, Box{1, 1, 1}, 1e-2);
  REQUIRE(loop.step(h).status < Status::infeasible);
}

// The shorter rod pulls the box up, the longer one pushes it into the ground.
TEST_CASE("rods that contradict each other are found through a box that stands on the ground") {
  auto loop = loop_of(1e-6);
  auto& set = rigid_bodies(loop);
  set.add_fixed(HalfSpace{});
  const auto box = set.add({.position = {0, 0, 0.5}, .mass = 1.0, .shape = Box{1, 1, 1}});
  for (const double length : {1.0, 3.0})
    loop.add(DistanceJoint::Item{world_anchor({0, 0, 2}), anchor(set, box), length});
  for (int n = 0; n < 30; ++n) {
    REQUIRE(loop.step(h).status == Status::infeasible);
    REQUIRE(set.velocity(box).norm() < 0.2 * 1.5 / h);  // less than what the longer rod asks for
  }
}

// Walls 0.5 m apart and a bar of 1 m; nothing but the compromise keeps it from tumbling.
TEST_CASE("a bar in half its room stays at rest, and is free within ten steps when a wall goes") {
  auto loop = loop_of(1e-6);
  auto& set = rigid_bodies(loop);
  set.add_fixed(HalfSpace{});
  set.add_fixed(HalfSpace{Vec3(1, 0, 0)}, {-0.25, 0, 0});
  const auto wall = set.add_fixed(HalfSpace{Vec3(-1, 0, 0)}, {0.25, 0, 0});
  const auto bar = set.add({.position = {0, 0, 0.1}, .mass = 1.0, .shape = Box{1, 0.2, 0.2}});
  for (int n = 0; n < 200; ++n) {
    REQUIRE(loop.step(h).status == Status::infeasible);
    REQUIRE(set.velocity(bar).norm() < 0.01);  // rounding and a tenth of g h
    REQUIRE(set.angular_velocity(bar).norm() < 0.1);
  }
  loop.remove(wall);
  for (int n = 0; n < 10; ++n) {
    loop.step(h);
    REQUIRE(set.velocity(bar).norm() < 1.5);  // pushed out at 1 m/s
  }
  REQUIRE(loop.report().status == Status::converged);
}

}  // namespace infeasible_scenes_tests
