#include "catch.hpp"

#include <delassus/delassus.hpp>
#include <delassus/steppers/newton_midpoint.hpp>
#include <delassus/steppers/rattle.hpp>

#include <limits>

namespace why_quarantined_tests {

using namespace delassus;

namespace {

const double not_a_number = std::numeric_limits<double>::quiet_NaN();
const double infinity = std::numeric_limits<double>::infinity();

}  // namespace

TEST_CASE("a force that is not finite is told with the body it was given to, not the first of its island") {
  AnimationLoop loop{World{RigidBodies{}}, Constraints{Contact{Coulomb{}}}};
  auto& set = bodies<RigidBodies>(loop.world());
  set.add_fixed(HalfSpace{});
  for (int k = 0; k < 3; ++k) set.add({.position = {0, 0, 0.5 + k}, .mass = 1.0, .shape = Box{1, 1, 1}});
  loop.step(0.01);
  REQUIRE(why_quarantined(loop).empty());
  set.apply_force(set.handle(2), {0, -infinity, 0});
  loop.step(0.01);
  REQUIRE(why_quarantined(loop) == "rigid body #2: the force or torque it was given for this step is not finite; 3 bodies stayed "
                                   "where they were");
  loop.step(0.01);
  REQUIRE(why_quarantined(loop).empty());
}

TEST_CASE("a torque or force on a body that is free is told too, by every way a body is moved") {
  const auto check = [](auto integrator, auto... constraints) {
    AnimationLoop loop{World{RigidBodies{}, Particles{}}, integrator, constraints...};
    auto& set = bodies<RigidBodies>(loop.world());
    auto& points = bodies<Particles>(loop.world());
    set.add({.mass = 1.0, .shape = Sphere{1}});
    const auto sick = set.add({.position = {5, 0, 0}, .mass = 1.0, .shape = Sphere{1}});
    const auto grain = points.add({.position = {9, 0, 0}, .mass = 1.0});
    set.apply_torque(sick, {0, not_a_number, 0});
    REQUIRE(loop.step(0.01).status == Status::quarantined);
    REQUIRE_THAT(why_quarantined(loop), Catch::StartsWith("rigid body #1: the force or torque it was given"));
    points.apply_force(grain, {0, 0, infinity});
    REQUIRE(loop.step(0.01).status == Status::quarantined);
    REQUIRE_THAT(why_quarantined(loop), Catch::StartsWith("particle #0: the force or torque it was given"));
    REQUIRE(loop.step(0.01).status == Status::converged);
    REQUIRE(why_quarantined(loop).empty());
  };
  check(SymplecticEuler{});
  check(Rattle{});
  check(SymplecticEuler{}, Constraints{BallJoint{}});
}

TEST_CASE("joints that a whole step solves are held by a bad force, and the body is named") {
  AnimationLoop loop{World{RigidBodies{}}, Constraints{BallJoint{}}, NewtonMidpoint{}};
  auto& set = bodies<RigidBodies>(loop.world());
  const auto upper = set.add({.position = {0, 0, -1}, .mass = 1.0, .shape = Sphere{0.1}});
  const auto lower = set.add({.position = {0, 0, -2}, .mass = 1.0, .shape = Sphere{0.1}});
  loop.add(BallJoint::Item{anchor(set, upper, {0, 0, 1}), world_anchor({0, 0, 0})});
  loop.add(BallJoint::Item{anchor(set, lower, {0, 0, 1}), anchor(set, upper)});
  set.apply_force(lower, {not_a_number, 0, 0});
  REQUIRE(loop.step(0.01).status == Status::quarantined);
  REQUIRE_THAT(why_quarantined(loop), Catch::StartsWith("rigid body #1: the force or torque it was given"));
}

TEST_CASE("a gravity that is not finite is told, and so is a number that is too large") {
  AnimationLoop loop{World{RigidBodies{}}};
  auto& set = bodies<RigidBodies>(loop.world());
  const auto ball = set.add({.mass = 1.0, .shape = Sphere{1}});
  set.gravity = {0, 0, not_a_number};
  loop.step(0.01);
  REQUIRE(why_quarantined(loop) == "rigid body #0: the gravity of its set is not finite; it stayed where it was");
  set.gravity.setZero();
  set.set_velocity(ball, {1e308, 0, 0});
  loop.step(10);
  REQUIRE(why_quarantined(loop) ==
          "rigid body #0: the step found no finite velocity for it, though loads and gravity are finite; it stayed where it was");
}

}  // namespace why_quarantined_tests
