#include <delassus/bodies/rigid_bodies.hpp>

#include <delassus/delassus.hpp>

#include <numbers>
#include <set>
#include <string>
#include <vector>

#include "catch.hpp"

using namespace delassus;

namespace {

template <class Loop>
auto& rigid_bodies(Loop& loop) {
  return loop.world().template set<0>();
}

}  // namespace

TEST_CASE("a kinematic body reaches the pose it is told, to the bit") {
  AnimationLoop loop{World{RigidBodies{}}};
  auto& set = rigid_bodies(loop);
  const auto body = set.add({.position = {1, 2, 3}, .motion = Motion::kinematic});
  for (int n = 1; n <= 50; ++n) {
    const Vec3 position(0.1 * n, std::sin(0.3 * n), -0.7 / n);
    const Quat turn(Eigen::AngleAxisd(0.4 * n, Vec3(1, 2, 2) / 3));
    set.move_to(body, position, turn);
    loop.step(1e-2);
    REQUIRE(set.position(body) == position);
    REQUIRE(set.orientation(body).coeffs() == turn.normalized().coeffs());
  }
  loop.step(1e-2);  // no new target: it stays
  REQUIRE(set.position(body).x() == 0.1 * 50);
}

TEST_CASE("a body that is moved or placed without an orientation keeps its own") {
  AnimationLoop loop{World{RigidBodies{}}};
  auto& set = rigid_bodies(loop);
  const Quat turn(Eigen::AngleAxisd(0.7, Vec3(1, 2, 2) / 3));
  const auto led = set.add({.orientation = turn, .motion = Motion::kinematic});
  const auto free = set.add({.orientation = turn, .mass = 1.0, .shape = Box{1, 1, 1}});
  const Quat before = set.orientation(led);
  set.move_to(led, {1, 0, 0});
  set.place(free, {0, 2, 0});
  CHECK(set.orientation(free).coeffs() == before.coeffs());
  CHECK(set.position(free) == Vec3(0, 2, 0));
  loop.step(1e-2);
  CHECK(set.position(led) == Vec3(1, 0, 0));
  // The target is made a unit quaternion once more, which moves each coefficient by a rounding.
  CHECK((set.orientation(led).coeffs() - before.coeffs()).norm() <= 4e-16);
}

TEST_CASE("a kinematic body with a velocity and no target moves with it") {
  AnimationLoop loop{World{RigidBodies{}}};
  auto& set = rigid_bodies(loop);
  const auto body =
      set.add({.velocity = {1, 0, 0}, .angular_velocity = {0, 0, 2}, .motion = Motion::kinematic});
  for (int n = 0; n < 100; ++n) loop.step(1e-2);
  // 100 roundings of numbers up to 2.
  CHECK((set.position(body) - Vec3(1, 0, 0)).norm() <= 1e-13);
  CHECK(set.orientation(body).angularDistance(Quat(Eigen::AngleAxisd(2, Vec3::UnitZ()))) <= 1e-7);
}

// The box meets the platform's velocity within the step: the contact rows ask for zero relative velocity,
// friction 1.
TEST_CASE("a moving platform carries the box that stands on it") {
  AnimationLoop loop{World{RigidBodies{}}, Constraints{Contact{Coulomb{.friction = 1}}},
                     AcceleratedGaussSeidel{.tolerance = 1e-10}};
  auto& set = rigid_bodies(loop);
  const auto platform =
      set.add({.position = {0, 0, -0.5}, .shape = Box{4, 4, 1}, .motion = Motion::kinematic});
  const auto box = set.add({.position = {0, 0, 0.5}, .mass = 1.0, .shape = Box{1, 1, 1}});
  const double h = 1e-2;
  for (int n = 1; n <= 200; ++n) {
    const double t = h * n;
    // Smooth start, at most 2 m/s² < μ g across and 1 m/s² < g down.
    set.move_to(platform, {1 - std::cos(1.4 * t), 0, -0.5 + 0.5 * std::sin(1.4 * t) * std::sin(1.4 * t)});
    loop.step(h);
  }
  // It stands where it stood on the platform; it may have sunk by what the contact takes back in each step, ≤
  // g h².
  const Vec3 off = set.position(box) - set.position(platform) - Vec3(0, 0, 1);
  CHECK(off.head<2>().norm() <= 1e-3);
  CHECK(std::abs(off.z()) <= 9.81 * h * h);
}

TEST_CASE("a fixed body stays to the bit, whatever hits or pulls it") {
  AnimationLoop loop{World{RigidBodies{}}, Constraints{BallJoint{}}};
  auto& set = rigid_bodies(loop);
  const auto post = set.add({.position = {0.1, 0.2, 0.3}, .motion = Motion::fixed});
  const auto load = set.add({.position = {1.1, 0.2, 0.3}, .mass = 1e6, .shape = Box{1, 1, 1}});
  loop.add(BallJoint::Item{anchor(set, post), anchor(set, load, {-1, 0, 0})});
  set.apply_force(post, {1e9, 0, 0});
  for (int n = 0; n < 100; ++n) loop.step(1e-2);
  CHECK(set.position(post) == Vec3(0.1, 0.2, 0.3));
  CHECK(set.velocity(post) == Vec3::Zero());
}

TEST_CASE("a force or torque acts during one step only") {
  AnimationLoop loop{World{RigidBodies{}}};
  auto& set = rigid_bodies(loop);
  set.gravity.setZero();
  const auto body = set.add({.mass = 2.0, .inertia = Mat3(4 * Mat3::Identity())});
  set.apply_force(body, {6, 0, 0});
  set.apply_torque(body, {0, 0, 8});
  const double h = 0.5;  // halves and small integers: no rounding but in the turn
  loop.step(h);
  const Vec3 v = set.velocity(body), w = set.angular_velocity(body);
  CHECK(v == Vec3(6 * h / 2, 0, 0));
  CHECK((w - Vec3(0, 0, 8 * h / 4)).norm() <= 1e-15);
  loop.step(h);
  CHECK(set.velocity(body) == v);
  CHECK((set.angular_velocity(body) - w).norm() <= 1e-15);
}

TEST_CASE("a force at a point turns a body by its moment about the centre of mass") {
  AnimationLoop loop{World{RigidBodies{}}};
  auto& set = rigid_bodies(loop);
  set.gravity.setZero();
  const auto body = set.add({.position = {1, 1, 1}, .mass = 2.0, .inertia = Mat3(4 * Mat3::Identity())});
  set.apply_force(body, {0, 3, 0}, {3, 1, 1});
  loop.step(0.5);
  CHECK(set.velocity(body) == Vec3(0, 3 * 0.5 / 2, 0));
  CHECK((set.angular_velocity(body) - Vec3(0, 0, 2 * 3 * 0.5 / 4)).norm() <= 1e-15);
}

TEST_CASE("a change of gravity acts from the next step on") {
  AnimationLoop loop{World{RigidBodies{}}};
  auto& set = rigid_bodies(loop);
  const auto body = set.add({.mass = 2.0, .shape = Sphere{1}});
  loop.step(0.5);
  set.gravity = {2, 0, 0};
  loop.step(0.5);
  CHECK((set.velocity(body) - Vec3(1, 0, -9.81 * 0.5)).norm() <= 1e-15);
}

namespace {

/// Two pendulums far apart and a link between a third and a fourth body; the third can be taken out.
struct Pair {
  AnimationLoop<World<RigidBodies>, Constraints<BallJoint>> loop{World{RigidBodies{}},
                                                                 Constraints{BallJoint{}}};
  std::vector<RigidBodies::Handle> body;
  std::vector<ConstraintHandle<BallJoint>> pin;

  explicit Pair(bool with_third) {
    auto& set = rigid_bodies(loop);
    for (int i = 0; i < (with_third ? 4 : 2); ++i)
      body.push_back(set.add({.position = {10.0 * i, 0, 0},
                              .angular_velocity = {1, 2, 3},
                              .mass = 1.0 + i,
                              .shape = Box{1, 2, 3}}));
    for (int i = 0; i < 2; ++i)
      pin.push_back(
          loop.add(BallJoint::Item{anchor(set, body[i], {0, 0.5, 0.5}), world_anchor({10.0 * i, 0.5, 0.5})}));
    if (with_third)
      pin.push_back(
          loop.add(BallJoint::Item{anchor(set, body[2], {5, 0, 0}), anchor(set, body[3], {-5, 0, 0})}));
  }
};

}  // namespace

TEST_CASE("a body taken out takes its joints with it, and changes no bit of the others") {
  Pair with(true), without(false);
  for (int n = 0; n < 20; ++n) {
    with.loop.step(1e-2);
    without.loop.step(1e-2);
  }
  with.loop.remove(with.body[2]);
  for (int n = 0; n < 200; ++n) {
    with.loop.step(1e-2);
    without.loop.step(1e-2);
    for (int i = 0; i < 2; ++i) {
      REQUIRE(rigid_bodies(with.loop).position(with.body[i]) ==
              rigid_bodies(without.loop).position(without.body[i]));
      REQUIRE(rigid_bodies(with.loop).angular_velocity(with.body[i]) ==
              rigid_bodies(without.loop).angular_velocity(without.body[i]));
    }
  }
  CHECK(with.loop.report().rows == 6);
  CHECK_THROWS_WITH(with.loop.impulse(with.pin[2]),
                    "delassus: impulse: this constraint was removed, or is another loop's; its handle is stale");
  CHECK_THROWS_WITH(rigid_bodies(with.loop).position(with.body[2]),
                    "delassus: rigid body #2 was removed; its handle is stale");
  // The one that lost its partner falls freely: nothing holds its momentum in x.
  CHECK(std::abs(rigid_bodies(with.loop).velocity(with.body[3]).z()) >= 9.81 * 2 * 0.99);
}

TEST_CASE("a place used again belongs to the new body alone") {
  AnimationLoop loop{World{RigidBodies{}}, Constraints{BallJoint{}}};
  auto& set = rigid_bodies(loop);
  const auto old = set.add({.mass = 1.0, .shape = Sphere{1}});
  loop.add(BallJoint::Item{anchor(set, old), world_anchor({0, 0, 1})});
  loop.remove(old);
  const auto fresh = set.add({.mass = 5.0, .shape = Sphere{1}});
  REQUIRE(fresh.index == old.index);
  CHECK_FALSE(set.contains(old));
  loop.step(0.5);
  CHECK(set.velocity(fresh).z() == Approx(-9.81 * 0.5).epsilon(1e-15));  // no joint holds it
  CHECK_THROWS_WITH(set.apply_force(old, {1, 0, 0}),
                    "delassus: rigid body #0 was removed; its handle is stale");
}

TEST_CASE("the handle of a number is its body's, and a number that no body had is refused") {
  AnimationLoop loop{World{RigidBodies{}}, Constraints{BallJoint{}}};
  auto& set = rigid_bodies(loop);
  const auto old = set.add({.mass = 1.0, .shape = Sphere{1}});
  CHECK(set.handle(0) == old);
  for (const Index none : {-1, 1, -2000000000, 2000000000})
    CHECK_THROWS_WITH(set.handle(none), "delassus: handle: rigid body #" + std::to_string(none) + " was never added");
  // A free place has nobody new yet: its handle is that of the body which was there.
  loop.remove(old);
  CHECK(set.handle(0) == old);
  CHECK_FALSE(set.contains(set.handle(0)));
  const auto fresh = set.add({.mass = 5.0, .shape = Sphere{1}});
  CHECK(set.handle(0) == fresh);
  CHECK(fresh != old);
}

TEST_CASE("a joint taken out lets go, and its handle is refused from then on") {
  Pair scene(false);
  auto& set = rigid_bodies(scene.loop);
  for (int n = 0; n < 5; ++n) scene.loop.step(1e-2);
  const double before = set.velocity(scene.body[1]).z();
  scene.loop.remove(scene.pin[1]);
  scene.loop.step(1e-2);
  CHECK(set.velocity(scene.body[1]).z() == Approx(before - 9.81 * 1e-2).epsilon(1e-14));
  CHECK_THROWS_WITH(scene.loop.remove(scene.pin[1]),
                    "delassus: remove: this constraint was removed before, or is another loop's; its handle is stale");
}

// A fall of 1 s and a swing of 1 s in single precision: 1000 steps of at most eight roundings of 2^-24 of 5 m
// or rad/s.
TEST_CASE("in single precision bodies fall and swing as in double, to single precision") {
  const auto run = [](auto set) {
    using Set = decltype(set);
    set.gravity = {0, 0, -9.81};
    AnimationLoop loop{World{std::move(set)}, Constraints{BallJoint{}}};
    auto& all = rigid_bodies(loop);
    const auto falls = all.add({.angular_velocity = {1, 2, 3}, .mass = 2.0, .shape = Box{1, 2, 3}});
    const auto swings = all.add({.position = {5, 0, 0}, .mass = 1.0, .shape = Box{1, 0.2, 0.2}});
    loop.add(BallJoint::Item{anchor(all, swings, {-0.5, 0, 0}), world_anchor({4.5, 0, 0})});
    for (int n = 0; n < 1000; ++n) loop.step(1e-3);
    STATIC_REQUIRE(
        std::is_same_v<scalar_t<std::remove_cvref_t<decltype(loop.world())>>, typename Set::Scalar>);
    return std::vector<Vec3>{all.position(falls), all.position(swings), all.angular_velocity(falls)};
  };
  const auto exact = run(RigidBodies{}), single = run(RigidBodiesF{});
  for (std::size_t i = 0; i < exact.size(); ++i) {
    CAPTURE(i);
    CHECK((exact[i] - single[i]).norm() <= 1000 * 8 * 0x1p-24 * 5);
  }
}

TEST_CASE("ten thousand hulls that come and go live in the place of two, and those that stay do not move") {
  std::vector<Vec3> corners;
  for (int i = 0; i < 8; ++i) corners.push_back(Vec3(i & 1 ? 1 : -1, i & 2 ? 1 : -1, i & 4 ? 1 : -1));
  const ConvexHull cube(corners);
  corners.push_back({0, 0, 3});
  const ConvexHull house(corners);
  RigidBodies set;
  const auto stays = set.add({.mass = 1.0, .shape = cube});
  const ConvexHull* const its_hull = set.shape(stays.index).hull;
  std::set<const ConvexHull*> places;
  for (int n = 0; n < 10000; ++n) {
    const ConvexHull& given = n % 2 ? cube : house;
    const auto comes = set.add({.mass = 1.0, .shape = given});
    const ConvexHull* hull = set.shape(comes.index).hull;
    REQUIRE(hull->vertices().size() == given.vertices().size());
    places.insert(hull);
    set.remove(comes);
    if (n % 3 == 0) set.remove(set.add({.mass = 1.0, .shape = Sphere{1}}));  // the same place without a hull
  }
  REQUIRE(places.size() == 1);
  REQUIRE(set.blocks() == 2);
  REQUIRE(set.shape(stays.index).hull == its_hull);
  REQUIRE(its_hull->vertices().size() == 8);
}
