// Surfaces that run beside their bodies: belts that do not move, tracks, rollers.
#include <delassus/activity/sleeping.hpp>
#include <delassus/bodies/rigid_bodies.hpp>
#include <delassus/constraints/contact/contact.hpp>
#include <delassus/constraints/contact/coulomb.hpp>
#include <delassus/constraints/contact/frictionless.hpp>
#include <delassus/constraints/contact/penalty.hpp>
#include <delassus/constraints/contact/rolling_coulomb.hpp>
#include <delassus/constraints/contact/sequential_restitution.hpp>
#include <delassus/integrators/implicit_midpoint.hpp>
#include <delassus/io/checkpoint.hpp>
#include <delassus/loop/animation_loop.hpp>
#include <delassus/schemes/collisions_first.hpp>

#include "catch.hpp"

#include <cmath>
#include <limits>
#include <type_traits>

namespace belts_tests {

using namespace delassus;

namespace {

constexpr double g = 9.81, h = 1.0 / 240, mu = 0.2;

auto scene(auto law, auto... policies) {
  return AnimationLoop{World{RigidBodies{}}, Constraints{Contact{law}}, policies...};
}
RigidBodies& set_of(auto& loop) { return bodies<RigidBodies>(loop.world()); }
/// A belt of 10 m along its own x, its upper side at z = 0, turned by `angle` about z.
auto add_belt(RigidBodies& set, double speed, double angle = 0, const Vec3& middle = {0, 0, -0.05}) {
  const auto belt = set.add_fixed(Box{10, 2, 0.1}, middle, exponential<double>(Vec3(0, 0, angle)));
  set.set_surface_velocity(belt, {speed, 0, 0});
  return belt;
}
auto add_parcel(RigidBodies& set, const Vec3& at = {0, 0, 0.1}) {
  return set.add({.position = at, .mass = 2.0, .shape = Box{0.4, 0.4, 0.2}});
}

}  // namespace

// Friction µ g speeds it up, by µ g h a step, for v/(µ g) = 0.2548 s; then it goes with the belt. To 1 s it goes
// v t − v²/(2 µ g), within v h.
TEST_CASE("a parcel on a still belt speeds up by mu g and ends at the speed of the surface") {
  const double v = 0.5;
  const auto carry = [&](auto... policies) {
    auto loop = scene(Coulomb{.friction = mu}, policies...);
    auto& set = set_of(loop);
    const auto belt = add_belt(set, v), parcel = add_parcel(set);
    for (int n = 1; n <= 240; ++n) {
      loop.step(h);
      CAPTURE(n);
      CHECK(set.velocity(parcel).x() == Approx(std::min(mu * g * n * h, v)).margin(1e-4));
    }
    CHECK(set.velocity(parcel).x() == Approx(v).epsilon(1e-5));
    CHECK(set.position(parcel).x() == Approx(v - v * v / (2 * mu * g)).margin(v * h));
    CHECK(set.velocity(belt) == Vec3::Zero());
  };
  carry();
  carry(ImplicitMidpoint{});
}

TEST_CASE("a surface velocity is in the axes of its body, and moves along the contact alone") {
  auto loop = scene(Coulomb{.friction = mu});
  auto& set = set_of(loop);
  const auto belt = add_belt(set, 0.5, EIGEN_PI / 2), parcel = add_parcel(set);
  set.set_surface_velocity(belt, {0.5, 0, 3});
  CHECK((set.surface_velocity(belt, {1, 0, 0}) - Vec3(0, 0.5, 3)).norm() <= 1e-15);
  for (int n = 0; n < 120; ++n) loop.step(h);
  CHECK((set.velocity(parcel) - Vec3(0, 0.5, 0)).norm() <= 1e-5);
  CHECK(set.position(parcel).z() == Approx(0.1).margin(1e-6));
  set.set_surface_velocity(belt, Vec3::Zero());
  for (int n = 0; n < 120; ++n) loop.step(h);
  CHECK(set.velocity(parcel).norm() <= 1e-5);
}

TEST_CASE("a parcel goes from a belt to the next one, and takes its speed") {
  auto loop = scene(Coulomb{.friction = mu});
  auto& set = set_of(loop);
  add_belt(set, 1.5, 0, {-5, 0, -0.05});
  add_belt(set, 0.4, 0, {5, 0, -0.05});
  const auto parcel = add_parcel(set, {-2, 0, 0.1});
  for (int n = 0; n < 960; ++n) loop.step(h);
  CHECK((set.velocity(parcel) - Vec3(0.4, 0, 0)).norm() <= 1e-5);
}

// The belt at y < 0 pushes along x and the other back: a torque about z.
TEST_CASE("belts that run against each other turn a parcel") {
  auto loop = scene(Coulomb{.friction = mu});
  auto& set = set_of(loop);
  add_belt(set, 0.5, 0, {0, -1, -0.05});
  add_belt(set, -0.5, 0, {0, 1, -0.05});
  const auto parcel = add_parcel(set);
  for (int n = 0; n < 30; ++n) loop.step(h);
  CHECK(set.angular_velocity(parcel).z() >= 0.5);
}

// A wheel of radius R whose surface runs at ω carries a plank at R ω, as one that turns.
TEST_CASE("wheels whose surfaces run carry a plank") {
  auto loop = scene(Coulomb{.friction = 0.5});
  auto& set = set_of(loop);
  for (int i = 0; i < 8; ++i)
    for (const double y : {0.0, 0.5}) {
      // Turned about its axis: the velocity is in its own axes.
      const auto wheel = set.add_fixed(Sphere{0.1}, {0.4 * i, y, -0.1}, exponential<double>(Vec3(0, 0.3 * i, 0)));
      set.set_surface_velocity(wheel, Vec3::Zero(), {0, 10, 0});
    }
  const auto plank = set.add({.position = {0.5, 0.25, 0.05}, .mass = 1.0, .shape = Box{1.4, 0.8, 0.1}});
  for (int n = 0; n < 240; ++n) loop.step(h);
  CHECK(set.velocity(plank).x() == Approx(1).epsilon(1e-4));
}

// Its tracks run backwards: on ground that holds them it goes forwards, by at most µ g.
// The same as on a disc that turns itself: what stands in its middle spins with it, what stands beside stays there.
TEMPLATE_TEST_CASE("a disc whose surface turns carries as one that turns itself", "", SymplecticEuler, ImplicitMidpoint) {
  const double rate = 1.5;
  for (const double r : {0.0, 0.8})
    for (const Shape& shape : {Shape(Box{0.4, 0.4, 0.2}), Shape(Cylinder{0.2, 0.2})}) {
      auto loop = scene(Coulomb{.friction = 0.3}, TestType{});
      RigidBodies& set = set_of(loop);
      const auto disc = set.add_fixed(Cylinder{3, 0.2}, {0, 0, -0.1});
      set.set_surface_velocity(disc, {0, 0, 0}, {0, 0, rate});
      const double start = r > 0 ? rate : 0;
      const auto body = set.add({.position = {r, 0, 0.1}, .velocity = {0, start * r, 0}, .angular_velocity = {0, 0, start}, .mass = 1, .shape = shape});
      for (int n = 0; n < 2 / h; ++n) loop.step(h);
      CAPTURE(r, int(shape.kind));
      // The midpoint rule does not know the way of a surface beside its body within the step: ω² r h/2 a second is lost at most.
      const double lost = std::is_same_v<TestType, ImplicitMidpoint> ? rate * rate * r * h : 0;
      CHECK(set.angular_velocity(body).z() == Approx(rate).epsilon(1e-4 + lost));
      CHECK(std::hypot(set.position(body).x(), set.position(body).y()) == Approx(r).margin(1e-4 + lost));
    }
}

TEST_CASE("a ball in the middle of a running disc takes its spin by torsional friction") {
  auto loop = scene(RollingCoulomb{.friction = 0.5, .rolling_friction = 1e-3, .torsional_friction = 5e-3});
  RigidBodies& set = set_of(loop);
  const auto disc = set.add_fixed(Cylinder{3, 0.2}, {0, 0, -0.1});
  set.set_surface_velocity(disc, {0, 0, 0}, {0, 0, 5});
  const auto ball = set.add({.position = {0, 0, 0.1}, .mass = 1, .shape = Sphere{0.1}});
  for (int n = 0; n < 3 / h; ++n) loop.step(h);
  CHECK(set.angular_velocity(ball).z() == Approx(5).epsilon(1e-6));
}

TEST_CASE("a body on tracks drives itself") {
  auto loop = scene(Coulomb{.friction = mu});
  auto& set = set_of(loop);
  set.add_fixed(HalfSpace{});
  const auto tank = add_parcel(set);
  set.set_surface_velocity(tank, {-0.5, 0, 0});
  for (int n = 1; n <= 120; ++n) {
    loop.step(h);
    CHECK(set.velocity(tank).x() == Approx(std::min(mu * g * n * h, 0.5)).margin(1e-4));
  }
}

TEST_CASE("a belt without friction carries nothing") {
  auto loop = scene(Frictionless{});
  auto& set = set_of(loop);
  add_belt(set, 0.5);
  const auto parcel = add_parcel(set);
  for (int n = 0; n < 60; ++n) loop.step(h);
  CHECK(set.velocity(parcel).head<2>().norm() <= 1e-12);
}

// What falls on it at V with e gets µ (1 + e) m V from the impact, while the surface is faster than that.
TEST_CASE("an impact on a belt has its friction, under impacts in turn too") {
  const double fast = 50, e = 0.5, V = 1;
  auto loop = scene(SequentialRestitution{Coulomb{.friction = mu}, e});
  auto& set = set_of(loop);
  set.gravity.setZero();
  add_belt(set, fast);
  const auto ball = set.add({.position = {0, 0, 0.1001}, .velocity = {0, 0, -V}, .mass = 1.0, .shape = Sphere{0.1}});
  for (int n = 0; n < 3; ++n) loop.step(h);
  CHECK(set.velocity(ball).z() == Approx(e * V).epsilon(1e-9));
  CHECK(set.velocity(ball).x() == Approx(mu * (1 + e) * V).epsilon(1e-9));
}

// A force of friction may go past the speed it shall reach, by µ g h at most.
TEST_CASE("a belt carries under contacts that are forces") {
  auto loop = scene(Penalty{Coulomb{.friction = mu}, 1e4, 1e2}, CollisionsFirst{});
  auto& set = set_of(loop);
  add_belt(set, 0.5);
  const auto parcel = add_parcel(set);
  for (int n = 0; n < 240; ++n) loop.step(h);
  CHECK(set.velocity(parcel).x() == Approx(0.5).margin(mu * g * h));
}

TEST_CASE("a belt that starts wakes what sleeps on it") {
  auto loop = scene(Coulomb{.friction = mu}, Sleeping{});
  auto& set = set_of(loop);
  const auto belt = add_belt(set, 0), parcel = add_parcel(set);
  for (int n = 0; n < 240; ++n) loop.step(h);
  REQUIRE_FALSE(set.is_awake(parcel.index));
  set.set_surface_velocity(belt, {0.5, 0, 0});
  for (int n = 0; n < 240; ++n) loop.step(h);
  CHECK(set.velocity(parcel).x() == Approx(0.5).epsilon(1e-5));
}

TEST_CASE("a sleeper whose own surface starts to run drives off") {
  auto loop = scene(Coulomb{.friction = mu}, Sleeping{});
  RigidBodies& set = set_of(loop);
  set.add_fixed(HalfSpace{});
  const auto cart = add_parcel(set);
  for (int n = 0; n < 1 / h; ++n) loop.step(h);
  REQUIRE(loop.dormant().bodies().size() == 1);
  set.set_surface_velocity(cart, {1, 0, 0});
  for (int n = 0; n < 2 / h; ++n) loop.step(h);
  CHECK(set.velocity(cart).x() == Approx(-1).epsilon(1e-6));  // and goes on: it does not fall asleep
}

TEST_CASE("a surface velocity goes with a copy and a checkpoint, and not to the next body in its place") {
  auto loop = scene(Coulomb{.friction = mu});
  auto& set = set_of(loop);
  const auto belt = add_belt(set, 0.5);
  add_parcel(set);
  auto copy = loop.clone();
  auto restored = scene(Coulomb{.friction = mu});
  restore(restored, checkpoint(loop));
  for (auto* each : {&loop, &copy, &restored}) {
    for (int n = 0; n < 120; ++n) each->step(h);
    CHECK(set_of(*each).velocity(set_of(*each).handle(1)).x() == Approx(0.5).epsilon(1e-5));
  }
  loop.remove(belt);
  const auto next = set.add_fixed(HalfSpace{});
  REQUIRE(next.index == belt.index);
  CHECK(set.surface_velocity(next, Vec3::Zero()) == Vec3::Zero());
}

TEST_CASE("a surface velocity that is not finite is refused") {
  RigidBodies set;
  const auto belt = set.add_fixed(Box{1, 1, 1});
  const double infinity = std::numeric_limits<double>::infinity();
  CHECK_THROWS_WITH(set.set_surface_velocity(belt, {infinity, 0, 0}), Catch::Contains("rigid body #0: surface velocity is not finite"));
  CHECK_THROWS_WITH(set.set_surface_velocity(belt, Vec3::Zero(), {0, std::nan(""), 0}), Catch::Contains("surface velocity is not finite"));
  CHECK(set.surface_velocity(belt, Vec3::Zero()) == Vec3::Zero());
}

}  // namespace belts_tests
