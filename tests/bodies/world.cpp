#include <delassus/bodies/world.hpp>

#include <delassus/delassus.hpp>

#include <cmath>
#include <limits>
#include <numbers>
#include <vector>

#include "catch.hpp"

using namespace delassus;

using Debris = Tagged<RigidBodies, struct DebrisTag>;

// One impulse pair at the bob's place: Σ m v of both falls as the weight, x of the common centre stays.
TEST_CASE("a rigid body and a particle joined to each other fall as one") {
  AnimationLoop loop{World{RigidBodies{}, Particles{}}, Constraints{BallJoint{}, DistanceJoint{}},
                     AcceleratedGaussSeidel{.tolerance = 1e-12}};
  auto& rigid = bodies<RigidBodies>(loop.world());
  auto& points = bodies<Particles>(loop.world());
  const auto box = rigid.add({.angular_velocity = {0, 3, 0}, .mass = 2.0, .shape = Box{1, 1, 1}});
  const auto bob = points.add({.position = {0.5, 0, 0}, .mass = 1.0});
  const auto far = points.add({.position = {2.5, 0, 0}, .mass = 0.5});
  loop.add(BallJoint::Item{anchor(rigid, box, {0.5, 0, 0}), anchor(points, bob)});
  loop.add(DistanceJoint::Item{anchor(points, bob), anchor(points, far), 2.0});
  const Vec3 start = momentum(rigid) + momentum(points);
  const double h = 1e-3;
  for (int n = 0; n < 500; ++n) {
    const StepReport report = loop.step(h);
    REQUIRE(report.status == Status::converged);
    REQUIRE(report.islands == 1);
    REQUIRE(report.rows == 4);
    // Bounded by the turn within a step, (h |ω|)² · length with |ω| below 10 rad/s, of which 0.2 goes back
    // each step.
    REQUIRE(report.max_joint_violation <= 1e-4 * 2 * 5);
  }
  const Vec3 weight(0, 0, -9.81 * 3.5 * 0.5);
  CHECK((momentum(rigid) + momentum(points) - start - weight).norm() <=
        1e-11);  // 500 steps of 1e-14 of 17 N·s
}

TEST_CASE("a particle and a rigid body without rotation swing alike on a rod") {
  AnimationLoop loop{World{RigidBodies{}, Particles{}}, Constraints{DistanceJoint{}}};
  auto& rigid = bodies<RigidBodies>(loop.world());
  auto& points = bodies<Particles>(loop.world());
  const auto ball = rigid.add({.position = {1, 0, 0}, .mass = 2.0, .shape = Sphere{0.1}});
  const auto bob = points.add({.position = {1, 5, 0}, .mass = 2.0});
  loop.add(DistanceJoint::Item{anchor(rigid, ball), world_anchor({0, 0, 0}), 1.0});
  loop.add(DistanceJoint::Item{anchor(points, bob), world_anchor({0, 5, 0}), 1.0});
  for (int n = 0; n < 1000; ++n) {
    loop.step(1e-3);
    // The same equations through other arithmetic, 1000 steps of a few roundings each.
    REQUIRE((rigid.position(ball) - points.position(bob) + Vec3(0, 5, 0)).norm() <= 1e-11);
  }
}

TEST_CASE("a second set of one type has its own bodies, gravity and handles") {
  AnimationLoop loop{World{RigidBodies{}, Debris{}}, Constraints{BallJoint{}}};
  auto& main = bodies<RigidBodies>(loop.world());
  auto& debris = bodies<Debris>(loop.world());
  debris.gravity = {0, 0, 0};
  const auto a = main.add({.mass = 1.0, .shape = Sphere{1}});
  const auto b = debris.add({.mass = 1.0, .shape = Sphere{1}});
  loop.step(0.5);
  CHECK(main.velocity(a) == Vec3(0, 0, -9.81 * 0.5));
  CHECK(debris.velocity(b) == Vec3(0, 0, 0));
  CHECK_THROWS_WITH(main.position(b), "delassus: this rigid body handle belongs to another world");
  // A joint between the sets, and its end with the body of one of them.
  loop.add(BallJoint::Item{anchor(main, a), anchor(debris, b, debris.pose(0).to_local(main.position(a)))});
  loop.step(0.5);
  CHECK(loop.report().rows == 3);
  CHECK(debris.velocity(b).z() < 0);
  loop.remove(b);
  loop.step(0.5);
  CHECK(loop.report().rows == 0);
}

TEST_CASE("what belongs to another world is refused") {
  AnimationLoop here{World{RigidBodies{}, Particles{}}, Constraints{BallJoint{}}};
  AnimationLoop there{World{RigidBodies{}, Particles{}}, Constraints{BallJoint{}}};
  auto& ours = bodies<RigidBodies>(here.world());
  auto& theirs = bodies<RigidBodies>(there.world());
  const auto mine = ours.add({.mass = 1.0, .shape = Sphere{1}});
  const auto foreign = theirs.add({.mass = 1.0, .shape = Sphere{1}});
  const auto particle = bodies<Particles>(there.world()).add({.mass = 1.0});
  CHECK_THROWS_WITH(ours.velocity(foreign), "delassus: this rigid body handle belongs to another world");
  CHECK_THROWS_WITH(bodies<Particles>(here.world()).velocity(particle),
                    "delassus: this particle handle belongs to another world");
  CHECK_THROWS_WITH(anchor(ours, foreign),
                    "delassus: anchor: the handle of rigid body #0 is stale or of another world");
  CHECK_THROWS_WITH(here.remove(foreign), "delassus: remove: this handle belongs to another world");
  CHECK_THROWS_WITH(here.add(BallJoint::Item{anchor(ours, mine), anchor(theirs, foreign)}),
                    "delassus: constraint, second end: the anchor belongs to a body of another world");
  CHECK(ours.contains(mine));
  CHECK_FALSE(ours.contains(foreign));
}

TEST_CASE("a handle that was never assigned is told so, wherever it is given") {
  AnimationLoop loop{World{RigidBodies{}, Particles{}}, Constraints{BallJoint{}}};
  auto& set = bodies<RigidBodies>(loop.world());
  set.add({.mass = 1.0, .shape = Sphere{1}});
  const RigidBodies::Handle body;
  const ConstraintHandle<BallJoint> joint;
  const auto never = [](const char* what, const char* kind) {
    return std::string("delassus: ") + what + "this " + kind + " handle was never assigned; keep the one that add(...) returns";
  };
  CHECK_THROWS_WITH(set.position(body), never("", "rigid body"));
  CHECK_THROWS_WITH(set.apply_force(body, {1, 0, 0}), never("", "rigid body"));
  CHECK_THROWS_WITH(bodies<Particles>(loop.world()).position({}), never("", "particle"));
  CHECK_THROWS_WITH(anchor(set, body), never("anchor: ", "body"));
  CHECK_THROWS_WITH(loop.remove(body), never("remove: ", "body"));
  CHECK_THROWS_WITH(loop.remove(joint), never("remove: ", "constraint"));
  CHECK_THROWS_WITH(loop.impulse(joint), never("impulse: ", "constraint"));
  CHECK_THROWS_WITH(loop.item(joint), never("item: ", "constraint"));
}

TEST_CASE("a world says where an anchor is that no loop has seen") {
  AnimationLoop loop{World{Particles{}, RigidBodies{}}};
  auto& set = bodies<RigidBodies>(loop.world());
  const Quat turn(Eigen::AngleAxisd(0.5 * std::numbers::pi, Vec3(0, 0, 1)));
  const auto body = set.add({.position = {1, 2, 3}, .orientation = turn, .mass = 1.0, .shape = Sphere{1}});
  const Anchor end = anchor(set, body, {1, 0, 0});
  const double rounding = 8 * std::numeric_limits<double>::epsilon();
  CHECK((loop.world().point(end) - Vec3(1, 3, 3)).norm() <= 4 * rounding);  // sums of numbers up to 3
  CHECK((loop.world().axes(end) - turn.toRotationMatrix()).norm() <= rounding);
  CHECK(loop.world().frame(end).angularDistance(turn) <= 2 * std::sqrt(rounding));  // by an arc cosine near 1
  CHECK(loop.world().point(world_anchor({4, 5, 6})) == Vec3(4, 5, 6));
  AnimationLoop other{World{Particles{}, RigidBodies{}}};
  CHECK_THROWS_WITH(other.world().point(end), "delassus: point: the anchor belongs to a body of another world");
  loop.remove(body);
  CHECK_THROWS_WITH(loop.world().frame(end), "delassus: frame: rigid body #0 was removed; its anchor is stale");
}

TEST_CASE("an anchor on a body that is gone is refused") {
  AnimationLoop loop{World{RigidBodies{}}, Constraints{BallJoint{}}};
  auto& set = bodies<RigidBodies>(loop.world());
  const auto body = set.add({.mass = 1.0, .shape = Sphere{1}});
  const Anchor end = anchor(set, body);
  loop.remove(body);
  CHECK_THROWS_WITH(anchor(set, body),
                    "delassus: anchor: the handle of rigid body #0 is stale or of another world");
  CHECK_THROWS_WITH(loop.add(BallJoint::Item{end, world_anchor({})}),
                    "delassus: constraint, first end: rigid body #0 was removed; its anchor is stale");
  set.add({.mass = 1.0, .shape = Sphere{1}});  // takes the place, not the name
  CHECK_THROWS_WITH(loop.add(BallJoint::Item{end, world_anchor({})}),
                    "delassus: constraint, first end: rigid body #0 was removed; its anchor is stale");
}
