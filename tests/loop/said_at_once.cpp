// Scenes that make no sense: refused where they are built, or said once in the report of the first step.
#include <delassus/bodies/particles.hpp>
#include <delassus/bodies/rigid_bodies.hpp>
#include <delassus/bodies/world.hpp>
#include <delassus/constraints/constraints.hpp>
#include <delassus/constraints/contact/contact.hpp>
#include <delassus/constraints/contact/coulomb.hpp>
#include <delassus/constraints/joints/ball_joint.hpp>
#include <delassus/constraints/joints/distance_joint.hpp>
#include <delassus/loop/animation_loop.hpp>
#include <delassus/loop/what_is_odd.hpp>

#include <cmath>
#include <type_traits>

#include "catch.hpp"

namespace said_at_once_tests {

using namespace delassus;
using Catch::Contains;

constexpr double h = 1e-3;

auto jointed() { return AnimationLoop{World{RigidBodies{}, Particles{}}, Constraints{BallJoint{}, DistanceJoint{}}}; }
auto& rigid(auto& loop) { return bodies<RigidBodies>(loop.world()); }
auto box(auto& loop, const Vec3& at) { return rigid(loop).add({.position = at, .mass = 1.0, .shape = Box{1, 1, 1}}); }

TEST_CASE("a joint between ends that nothing moves is refused by add") {
  auto loop = jointed();
  auto& set = rigid(loop);
  auto& points = bodies<Particles>(loop.world());
  const auto wall = set.add_fixed(Box{1, 1, 1});
  const auto led = set.add({.position = {10, 0, 0}, .motion = Motion::kinematic});
  const auto pin = points.add({.is_fixed = true}), bob = points.add({.mass = 1.0});
  const auto free = box(loop, {0, 0, 5});
  const auto pillar = set.add_fixed(Box{1, 1, 1}, {0, 20, 0});
  CHECK_THROWS_WITH(loop.add(BallJoint::Item{anchor(set, wall), anchor(set, pillar)}),
                    Contains("rigid body #0 and rigid body #3 never move"));
  CHECK_THROWS_WITH(loop.add(BallJoint::Item{anchor(set, wall), world_anchor({0, 0, 0})}), Contains("rigid body #0 and the world never move"));
  CHECK_THROWS_AS(loop.add(DistanceJoint::Item{anchor(points, pin), anchor(set, wall)}), InvalidArgument);
  CHECK_NOTHROW(loop.add(BallJoint::Item{anchor(set, led), anchor(set, free)}));
  CHECK_NOTHROW(loop.add(BallJoint::Item{anchor(points, bob), anchor(set, wall)}));
}

TEST_CASE("a joint between bodies that their user leads is said when they start apart") {
  auto loop = jointed();
  auto& set = rigid(loop);
  const auto a = set.add({.motion = Motion::kinematic}), b = set.add({.position = {10, 0, 0}, .motion = Motion::kinematic});
  loop.add(BallJoint::Item{anchor(set, a), anchor(set, b)});
  CHECK(loop.step(h).starts_apart);
}

// The arm is 0.5 m long: a tenth of it is 5 cm.
TEST_CASE("a joint whose ends are far apart is said in the first report alone") {
  for (const double gap : {0.0, 0.04, 0.06, 10.0}) {
    auto loop = jointed();
    const auto body = box(loop, {0.5 + gap, 0, 0});
    loop.add(BallJoint::Item{anchor(rigid(loop), body, {-0.5, 0, 0}), world_anchor({0, 0, 0})});
    CHECK(loop.step(h).starts_apart == (gap > 0.05));
    if (gap > 0.05) CHECK_THAT(what_is_odd(loop), Contains("the ends of a joint are " + inner::text(gap) + " m"));
    else CHECK(what_is_odd(loop).empty());
    CHECK_FALSE(loop.step(h).starts_apart);
    CHECK(what_is_odd(loop).empty());
  }
}

TEST_CASE("shapes that overlap where no contact law is named are said in the first report alone") {
  auto loop = jointed();
  rigid(loop).add_fixed(HalfSpace{});
  box(loop, {0, 0, 0.4});
  CHECK(loop.step(h).overlaps_unseen);
  CHECK_THAT(what_is_odd(loop), Contains("rigid body #0 and rigid body #1 overlap, and no contact law keeps them apart"));
  CHECK_FALSE(loop.step(h).overlaps_unseen);
  CHECK(what_is_odd(loop).empty());

  AnimationLoop free{World{RigidBodies{}}};
  box(free, {0, 0, 0});
  rigid(free).add({.position = {0.8, 0.3, 0}, .mass = 1.0, .shape = Capsule{0.5, 1}});
  CHECK(free.step(h).overlaps_unseen);
  CHECK_FALSE(free.step(h).overlaps_unseen);
}

TEST_CASE("shapes that touch, that a joint connects or that do not meet by their groups are not said to overlap") {
  auto touching = jointed();
  rigid(touching).add_fixed(HalfSpace{});
  for (int k = 0; k < 4; ++k) box(touching, {0, 0, 0.5 + k});
  // Corner to corner: their boxes along the axes overlap by half a metre each way, they are 7 cm apart.
  rigid(touching).add({.position = {5, 0, 2}, .orientation = Quat(Eigen::AngleAxisd(0.785398, Vec3::UnitZ())), .mass = 1.0, .shape = Box{1, 1, 1}});
  rigid(touching).add({.position = {5.75, 0.75, 2}, .orientation = Quat(Eigen::AngleAxisd(0.785398, Vec3::UnitZ())), .mass = 1.0, .shape = Box{1, 1, 1}});
  CHECK_FALSE(touching.step(h).overlaps_unseen);

  auto joined = jointed();
  const auto a = box(joined, {0, 0, 0}), b = box(joined, {0.5, 0, 0});
  joined.add(BallJoint::Item{anchor(rigid(joined), a, {0.25, 0, 0}), anchor(rigid(joined), b, {-0.25, 0, 0})});
  rigid(joined).add({.mass = 1.0, .shape = Sphere{1}, .group = 2, .collides_with = 2});
  CHECK_FALSE(joined.step(h).overlaps_unseen);

  AnimationLoop seen{World{RigidBodies{}}, Constraints{Contact{Coulomb{}}}};
  box(seen, {0, 0, 0}), box(seen, {0.9, 0, 0});
  CHECK_FALSE(seen.step(h).overlaps_unseen);
}

/// Adds to its loop in the middle of a step.
struct Meddler {
  using plays = role::Listener;
  using listens = Listens<stage::Solve>;
  RigidBodies* set = nullptr;
  void after(stage::Solve, const auto&) {
    if (set) set->add({.mass = 1.0, .shape = Sphere{1}});
  }
};

TEST_CASE("a body that a listener adds during a step is refused, and the bodies stay where they were") {
  AnimationLoop loop{World{RigidBodies{}}, Constraints{Contact{Coulomb{}}}, Meddler{}};
  const auto body = box(loop, {0, 0, 3});
  loop.get<Meddler>().set = &rigid(loop);
  CHECK_THROWS_WITH(loop.step(h), Contains("rigid body #1: it is added while a step runs"));
  CHECK(rigid(loop).blocks() == 1);
  CHECK(rigid(loop).position(body).z() == 3);
  loop.get<Meddler>().set = nullptr;
  box(loop, {0, 0, 6});
  CHECK(loop.step(h).status == Status::converged);
}

TEST_CASE("a stiffness that is no number is reported, and does not make a joint rigid") {
  auto loop = jointed();
  const auto body = box(loop, {0, 0, 0});
  const auto spring = loop.add(DistanceJoint::Item{anchor(rigid(loop), body), world_anchor({0, 0, 2}), 1.0, 100.0});
  loop.item(spring).stiffness = std::nan("");
  CHECK(loop.step(h).status == Status::quarantined);
  CHECK(rigid(loop).position(body) == Vec3(0, 0, 0));
}

TEST_CASE("a world and a loop are moved or cloned, and never copied") {
  auto loop = jointed();
  using Loop = decltype(loop);
  STATIC_REQUIRE_FALSE(std::is_copy_constructible_v<Loop>);
  STATIC_REQUIRE_FALSE(std::is_copy_assignable_v<Loop>);
  STATIC_REQUIRE_FALSE(std::is_copy_constructible_v<Loop::WorldType>);
  STATIC_REQUIRE_FALSE(std::is_copy_assignable_v<Loop::WorldType>);
  STATIC_REQUIRE(std::is_move_constructible_v<Loop>);
  const auto body = box(loop, {0, 0, 0});
  auto twin = loop.clone();
  twin.step(h);
  CHECK(rigid(loop).position(body).z() == 0);
  CHECK(rigid(twin).position(body).z() < 0);
  CHECK(bodies<RigidBodies>(loop.world().clone()).position(body).z() == 0);
}

}  // namespace said_at_once_tests
