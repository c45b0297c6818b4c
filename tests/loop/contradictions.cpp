#include "scenes.hpp"

#include <delassus/solvers/direct_gauss_seidel.hpp>
#include <delassus/solvers/proximal_newton.hpp>

#include "catch.hpp"

namespace contradictions_tests {

using namespace scenes;

namespace {

constexpr double h = 0.01;

}  // namespace

// The walls push out at 1 m/s at most, by as much from both sides; a body that is fed energy flies.
TEST_CASE("a box between walls that leave it no room stays slow, and is free when a wall goes") {
  AnimationLoop loop{World{RigidBodies{}}, Constraints{Contact{Coulomb{.friction = 0.5}}}};
  auto& set = rigid_bodies(loop);
  set.add_fixed(HalfSpace{});
  set.add_fixed(HalfSpace{Vec3(1, 0, 0)}, {-0.45, 0, 0});
  const auto wall = set.add_fixed(HalfSpace{Vec3(-1, 0, 0)}, {0.45, 0, 0});
  const auto box = set.add({.position = {0, 0, 0.5}, .mass = 1.0, .shape = Box{1, 1, 1}});
  int lost = 0;
  for (int n = 0; n < 1000; ++n) {
    lost += loop.step(h).status == Status::infeasible;
    REQUIRE(set.velocity(box).norm() <= 1);
  }
  REQUIRE(lost > 500);  // and it says so
  loop.remove(wall);
  StepReport r;
  for (int n = 0; n < 300; ++n) r = loop.step(h);
  REQUIRE(r.status == Status::converged);
  REQUIRE(set.velocity(box).norm() <= 0.1);
}

namespace {

/// Steps of 0.01 s while something contradicts itself, then without: how many said so, the most energy (J)
/// meanwhile, the largest impulse (N·s), and the steps until all is met and at rest again.
struct Recovered {
  int said = 0, steps = 1000;
  double energy = 0, impulse = 0;
};
template <class Loop, class Impulse, class Relieve>
Recovered contradict(Loop& loop, const Impulse& impulse, const Relieve& relieve) {
  auto& set = rigid_bodies(loop);
  Recovered seen;
  for (int n = 0; n < 200; ++n) {
    seen.said += loop.step(h).status == Status::infeasible;
    seen.impulse = std::max(seen.impulse, impulse());
    if (n >= 100) seen.energy = std::max(seen.energy, kinetic_energy(set));
  }
  relieve();
  for (int n = 1; n <= 100 && seen.steps == 1000; ++n)
    if (loop.step(h).status == Status::converged && kinetic_energy(set) <= 1e-6) seen.steps = n;
  return seen;
}

}  // namespace

// HC-22: impulses bounded, it says so, no energy in what is free, and all is well ten steps after the
// conflict ends. Sweeps that no one stops would add h m g or 1 N·m·s each; a hundred of them bound the
// impulses.
TEMPLATE_TEST_CASE(
    "a pin below the floor, and motors that oppose each other, are told, bounded, and forgotten at once", "",
    AcceleratedGaussSeidel, DirectGaussSeidel) {
  {
    AnimationLoop loop{World{RigidBodies{}}, Constraints{Contact{Coulomb{.friction = 0.5}}, BallJoint{}},
                       PositionProjection{}, TestType{}};
    auto& set = rigid_bodies(loop);
    set.add_fixed(HalfSpace{});
    const auto box = set.add({.position = {0, 0, 0.5}, .mass = 1.0, .shape = Box{1, 1, 1}});
    const auto pin = loop.add(BallJoint::Item{anchor(set, box), world_anchor({0, 0, 0.4})});
    const Recovered seen = contradict(
        loop, [&] { return loop.impulse(pin).norm(); }, [&] { loop.remove(pin); });
    CAPTURE(seen.said, seen.energy, seen.impulse, seen.steps);
    CHECK(seen.said >= 190);
    CHECK(seen.energy <= 1e-6);
    CHECK(seen.impulse <= 100 * h * g);
    CHECK(seen.steps <= 10);
  }
  {
    AnimationLoop loop{World{RigidBodies{}}, Constraints{Hinge{}, Motor<Turn>{}}, TestType{}};
    auto& set = rigid_bodies(loop);
    set.gravity.setZero();
    const auto wheel = set.add({.mass = 1.0, .inertia = Mat3(Mat3::Identity())});
    const Anchor a = world_anchor({0, 0, 0}), b = anchor(set, wheel);
    loop.add(Hinge::Item{a, b});
    const auto forth = loop.add(Motor<Turn>::Item{.a = a, .b = b, .speed = 1});
    const auto back = loop.add(Motor<Turn>::Item{.a = a, .b = b, .speed = -1});
    const Recovered seen = contradict(
        loop, [&] { return std::abs(loop.impulse(forth)[0]); },
        [&] {
          loop.remove(back);
          loop.item(forth).speed = 0;
        });
    CAPTURE(seen.said, seen.energy, seen.impulse, seen.steps);
    CHECK(seen.said >= 190);
    CHECK(seen.energy <= 1e-6);
    CHECK(seen.impulse <= 10);  // 1 rad/s of 1 kg·m² over 0.105: 9.5
    CHECK(seen.steps <= 10);
  }
}

// A bar between four: three rods of 1 m on posts 1 % further apart than they reach when level.
TEMPLATE_TEST_CASE(
    "a loop that is a per cent too short is told, pulls with bounded force, and is free at once", "",
    AcceleratedGaussSeidel, DirectGaussSeidel) {
  AnimationLoop loop{World{RigidBodies{}}, Constraints{BallJoint{}}, PositionProjection{}, TestType{}};
  auto& set = rigid_bodies(loop);
  set.gravity.setZero();
  Anchor end = world_anchor({0, 0, 0});
  for (int k = 0; k < 3; ++k) {
    const auto rod = set.add({.position = {0.5 + k, 0, 0},
                              .mass = 1.0,
                              .inertia = Mat3(Vec3(1e-2, 1. / 12, 1. / 12).asDiagonal())});
    loop.add(BallJoint::Item{end, anchor(set, rod, {-0.5, 0, 0})});
    end = anchor(set, rod, {0.5, 0, 0});
  }
  const auto last = loop.add(BallJoint::Item{end, world_anchor({3.03, 0, 0})});
  const Recovered seen = contradict(
      loop, [&] { return loop.impulse(last).norm(); }, [&] { loop.remove(last); });
  CAPTURE(seen.said, seen.energy, seen.impulse, seen.steps);
  CHECK(seen.said >= 190);
  CHECK(seen.energy <= 1e-6);
  // 0.6 m/s of three rods, over the share by which rows yield: a tenth in sweeps, 1e-4 in a factorization.
  CHECK(seen.impulse <= (std::is_same_v<TestType, DirectGaussSeidel> ? 3 * 0.6 / 1e-4 : 3 * 0.6 / 0.105));
  CHECK(seen.steps <= 10);
}

TEST_CASE("the impulses of joints that contradict each other do not grow from step to step") {
  AnimationLoop loop{World{RigidBodies{}}, Constraints{BallJoint{}}};
  auto& set = rigid_bodies(loop);
  const auto box = set.add({.position = {0, 0, 0}, .mass = 1.0, .shape = Box{1, 1, 1}});
  const auto a = loop.add(BallJoint::Item{anchor(set, box), world_anchor({0, 0, 0})});
  loop.add(BallJoint::Item{anchor(set, box), world_anchor({1, 0, 0})});
  double early = 0, late = 0;
  for (int n = 0; n < 2000; ++n) {
    loop.step(h);
    (n < 1000 ? early : late) = std::max(n < 1000 ? early : late, loop.impulse(a).norm());
  }
  REQUIRE(late <= 1.01 * early);
}

TEST_CASE("a joint with both ends on one body, or both in the world, is refused") {
  AnimationLoop loop{World{RigidBodies{}}, Constraints{BallJoint{}}};
  auto& set = rigid_bodies(loop);
  const auto box = set.add({.mass = 1.0, .shape = Box{1, 1, 1}});
  REQUIRE_THROWS_WITH(
      loop.add(BallJoint::Item{anchor(set, box), anchor(set, box, {1, 0, 0})}),
      Catch::Contains(
          "BallJoint: both ends are on rigid body #0; it would hold nothing, let one be on another body"));
  REQUIRE_THROWS_WITH(loop.add(BallJoint::Item{world_anchor({0, 0, 0}), world_anchor({0, 0, 1})}),
                      Catch::Contains("BallJoint: both ends are in the world"));
}

TEST_CASE("a joint between two bodies that do not answer has no impulse and spoils nothing") {
  AnimationLoop loop{World{RigidBodies{}}, Constraints{BallJoint{}}};
  auto& set = rigid_bodies(loop);
  const auto a = set.add({.shape = Box{1, 1, 1}, .motion = Motion::kinematic});
  const auto b = set.add({.position = {1, 0, 0}, .shape = Box{1, 1, 1}, .motion = Motion::kinematic});
  const auto joint = loop.add(BallJoint::Item{anchor(set, a), anchor(set, b)});
  const StepReport r = loop.step(h);
  REQUIRE(r.status == Status::converged);
  REQUIRE(loop.impulse(joint).norm() == 0);
}

TEST_CASE("the handle of one loop names nothing in another, and its copies share it") {
  AnimationLoop one{World{RigidBodies{}}, Constraints{BallJoint{}}};
  AnimationLoop two{World{RigidBodies{}}, Constraints{BallJoint{}}};
  const auto add = [](auto& loop) {
    auto& set = rigid_bodies(loop);
    return loop.add(
        BallJoint::Item{anchor(set, set.add({.mass = 1.0, .shape = Box{1, 1, 1}})), world_anchor({0, 0, 0})});
  };
  const auto joint = add(one);
  add(two);
  REQUIRE_THROWS_WITH(two.remove(joint), Catch::Contains("another loop's"));
  auto copy = one.clone();
  REQUIRE_NOTHROW(copy.remove(joint));
}

TEST_CASE("a body removed through its set takes its joints with it before the next step") {
  AnimationLoop loop{World{RigidBodies{}}, Constraints{BallJoint{}}};
  auto& set = rigid_bodies(loop);
  const auto box = set.add({.mass = 1.0, .shape = Box{1, 1, 1}});
  loop.add(BallJoint::Item{anchor(set, box), world_anchor({0, 0, 0})});
  loop.step(h);
  set.remove(box);
  const auto next = set.add({.mass = 1.0, .shape = Box{1, 1, 1}});
  REQUIRE(next.index == box.index);
  REQUIRE(loop.step(h).rows == 0);
  REQUIRE(set.velocity(next).z() == -g * h);
}

TEST_CASE("after something was taken out the last problem is empty, and a copied loop can be asked") {
  AnimationLoop loop{World{RigidBodies{}}, Constraints{BallJoint{}, Contact{Coulomb{}}}};
  auto& set = rigid_bodies(loop);
  set.add_fixed(HalfSpace{});
  const auto box = set.add({.position = {0, 0, 0.5}, .mass = 1.0, .shape = Box{1, 1, 1}});
  const auto joint = loop.add(BallJoint::Item{anchor(set, box, {0, 0, 0.5}), world_anchor({0, 0, 1})});
  loop.step(h);
  const auto count = [](const auto& l) {
    int n = 0;
    l.each_constraint([&](auto&&...) { ++n; });
    return n;
  };
  auto copy = std::make_unique<decltype(loop)>(loop.clone());
  REQUIRE(count(*copy) == 5);
  copy->remove(joint);
  REQUIRE(count(*copy) == 0);
  auto problem = copy->problem();
  REQUIRE(solve(problem, GaussSeidel{}).sweeps == 0);
  REQUIRE(count(loop) == 5);
}

TEST_CASE("a ball that rolls keeps its speed under the midpoint rule") {
  AnimationLoop loop{World{RigidBodies{}}, Constraints{Contact{Coulomb{.friction = 0.5}}},
                     ImplicitMidpoint{}};
  auto& set = rigid_bodies(loop);
  set.add_fixed(HalfSpace{});
  const auto ball = set.add({.position = {0, 0, 0.5},
                             .velocity = {2, 0, 0},
                             .angular_velocity = {0, 4, 0},
                             .mass = 1.0,
                             .shape = Sphere{0.5}});
  for (int n = 0; n < 600; ++n) loop.step(1.0 / 60);
  REQUIRE(set.velocity(ball).x() == Approx(2).epsilon(1e-6));
}

TEST_CASE("margins, thicknesses and counts of points that cannot be are refused") {
  const auto with = [](NativeCollision collision) {
    AnimationLoop loop{World{RigidBodies{}}, Constraints{Contact{Coulomb{}}}, collision};
  };
  REQUIRE_THROWS_WITH(with({.margin = INFINITY}),
                      Catch::Contains("NativeCollision: margin inf m must be finite"));
  REQUIRE_THROWS_WITH(with({.contact_distance = std::nan("")}), Catch::Contains("contact_distance"));
  REQUIRE_THROWS_WITH(with({.max_points = 9}), Catch::Contains("max_points 9 must be in [1, 8]"));
}

// All normals point up: a velocity upwards meets every row, so there is no contradiction to prove, however
// long it has rested.
TEST_CASE("a box at rest on two tiles of different heights is no contradiction") {
  AnimationLoop loop{World{RigidBodies{}}, Constraints{Contact{Coulomb{.friction = 0.6}}}};
  auto& set = rigid_bodies(loop);
  set.add_fixed(Box{0.2, 1, 1}, {-0.1, 0, -0.5});
  set.add_fixed(Box{0.2, 1, 1}, {0.1, 0, -0.5012});
  set.add({.position = {0, 0, 0.151}, .mass = 1.0, .shape = Box{0.3, 0.3, 0.3}});
  for (int n = 0; n < 400; ++n) {
    CAPTURE(n);
    REQUIRE(loop.step(h).status != Status::infeasible);
  }
}

// In single precision there is no room between a contradiction and a mass ratio: none is claimed.
// Two shafts on hinges whose axes meet, and a ball joint there: three rows too many, which agree but for the last digits. Nothing
// else is asked for where nothing pulls.
TEMPLATE_TEST_CASE("redundant joints that agree are no contradiction where nothing moves", "", AcceleratedGaussSeidel, DirectGaussSeidel,
                   ProximalNewton) {
  for (const double rate : {0.0, 2.0})
    for (const double angle : {0.5, 1.0}) {
      AnimationLoop loop{World{RigidBodies{}}, Constraints{Hinge{}, BallJoint{}}, TestType{}};
      auto& set = rigid_bodies(loop);
      set.gravity = {0, 0, 0};
      const Quat turn = exponential<double>(Vec3(0, angle, 0));
      const Vec3 axis = turn * Vec3(0, 0, 1);
      const auto a = set.add({.position = {0, 0, -1}, .angular_velocity = {0, 0, rate}, .mass = 1, .inertia = Mat3::Identity()});
      const auto b = set.add({.position = axis, .orientation = turn, .angular_velocity = rate * axis, .mass = 1, .inertia = Mat3::Identity()});
      loop.add(Hinge::Item{world_anchor({0, 0, -1}), anchor(set, a)});
      loop.add(Hinge::Item{world_anchor(axis, turn), anchor(set, b)});
      loop.add(BallJoint::Item{anchor_at(set, a, {0, 0, 0}), anchor_at(set, b, {0, 0, 0})});
      CAPTURE(rate, angle);
      for (int n = 0; n < 20; ++n) REQUIRE(loop.step(h).status <= Status::stalled);
      REQUIRE(set.angular_velocity(a).z() == Approx(rate).epsilon(1e-12));
    }
}

// A compromise is bounded by what pushes: a depth of 0.2 m pushed out in a step goes at 20 m/s, and turns the box at 100 rad/s.
TEST_CASE("a hinge that holds a box in the ground leaves it slow, also where the joints are solved directly") {
  for (int k = 0; k < 80; ++k) {
    AnimationLoop loop{World{RigidBodies{}}, Constraints{Contact{Coulomb{.friction = 0.6}}, Hinge{}}, DirectGaussSeidel{}};
    auto& set = rigid_bodies(loop);
    const int planes = 1 + k % 4;
    for (int i = 0; i < planes; ++i)
      set.add_fixed(HalfSpace{Vec3(0.3 * std::sin(7.0 * k + 3 * i), 0.3 * std::cos(5.0 * k + i), 1), -0.05 - 0.03 * ((k + i) % 6)});
    const auto box = set.add({.mass = 1.0, .shape = Box{0.5, 0.6, 0.5}});
    const Quat across = frame_along({0, 1, 0});
    loop.add(Hinge::Item{world_anchor({0, 0, 0}, across), anchor(set, box, {0, 0, 0}, across)});
    CAPTURE(k);
    for (int n = 0; n < 6; ++n) {
      loop.step(1.0 / 60);
      REQUIRE(set.angular_velocity(box).norm() <= 100);
    }
  }
}

TEST_CASE("nothing is called a contradiction in single precision") {
  AnimationLoop loop{World{RigidBodiesF{}}, Constraints{Contact{Coulomb{.friction = 0.5}}}};
  auto& set = bodies<RigidBodiesF>(loop.world());
  set.add_fixed(HalfSpace{});
  set.add({.position = {0, 0, 0.5}, .mass = 1.0, .shape = Box{1, 1, 1}});
  set.add({.position = {0, 0, 1.5}, .mass = 1e6, .shape = Box{1, 1, 1}});
  for (int n = 0; n < 20; ++n) REQUIRE(loop.step(h).status != Status::infeasible);
}

}  // namespace contradictions_tests
