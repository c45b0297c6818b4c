#include <delassus/solvers/direct_gauss_seidel.hpp>
#include <delassus/stabilisation/position_projection.hpp>

#include "catch.hpp"
#include "stabilisation/violated.hpp"

using namespace delassus;

TEST_CASE("position projection closes a joint by its rate and gives it no velocity, to the bit") {
  violated::Joint scene(PositionProjection{.rate = 0.25});
  double expected = 0.1;
  for (int n = 0; n < 20; ++n) {
    scene.loop.step(0.01);
    expected *= 0.75;
    REQUIRE(scene.set().velocity(scene.bob) == Vec3::Zero());
    REQUIRE(std::abs(scene.set().position(scene.bob).x() - expected) <= 1e-15);
  }
}

TEST_CASE("position projection lifts a sunk body and leaves it at rest") {
  violated::Sunk scene(PositionProjection{.rate = 0.2}, 0.01);
  double expected = 0.01;
  for (int n = 0; n < 10; ++n) {
    scene.loop.step(0.01);
    expected *= 0.8;
    // The contact carries the weight, m g h, and no more: a rounding of it is all the velocity there is.
    REQUIRE(scene.set().velocity(scene.ball).norm() <= 1e-16);
    REQUIRE(scene.depth() == Approx(expected).epsilon(1e-9));
  }
}

TEST_CASE("position projection moves an overlap apart no faster than its cap") {
  violated::Sunk scene(PositionProjection{.rate = 1, .max_speed = 0.3}, 0.2);
  const double h = 0.01;
  for (int n = 1; n <= 20; ++n) {
    scene.loop.step(h);
    REQUIRE(scene.depth() == Approx(0.2 - 0.3 * h * n).epsilon(1e-9));
  }
}

// Without a violation there is nothing to project: the trajectories agree to the rounding of a displacement
// of zero.
TEST_CASE("position projection changes nothing where nothing is violated") {
  violated::Joint projected(PositionProjection{}, 0.0);
  violated::Joint plain(Baumgarte{}, 0.0);
  for (int n = 0; n < 100; ++n) {
    projected.loop.step(0.01);
    plain.loop.step(0.01);
  }
  CHECK(projected.set().position(projected.bob) == plain.set().position(plain.bob));
}

// A gap of 0.3 m asks for 9 m/s at a rate of 0.3, more than `max_speed`, which is for overlaps: whichever way
// the joint is open it must close alike. Without gravity all that moves is the displacement, and it is the
// same scene turned round.
TEST_CASE("position projection closes a joint alike from either side") {
  const auto left_of = [](double gap) {
    AnimationLoop loop{World{RigidBodies{}}, Constraints{BallJoint{}}, PositionProjection{.rate = 0.3}};
    auto& set = bodies<RigidBodies>(loop.world());
    set.gravity.setZero();
    const auto bob = set.add({.position = {gap, 0, 0}, .mass = 1.0, .inertia = Mat3(Mat3::Identity())});
    loop.add(BallJoint::Item{world_anchor({0, 0, 0}), anchor(set, bob)});
    loop.step(0.01);
    return set.position(bob).x();
  };
  CHECK(left_of(0.3) == Approx(0.7 * 0.3).epsilon(1e-12));
  CHECK(left_of(-0.3) == Approx(-0.7 * 0.3).epsilon(1e-12));
}

// What goes across the joint is of the order of the step's change of speed times its turn, h α · h ω with
// α ω = g cos θ √(2 g sin θ) <= 27/s³; the 0.1 m/s of the start, of which a tenth fades a step, are gone
// after 200. What a displacement leaves of the gap that a step opens, at most h³ α ω/2, is its share by the
// turn of half a step, h ω/2 <= 0.022. Not known at the end of the step, the gap was h² α, and rounding that
// is turned round every step grew to 4 cm and 11 m/s within 200 000.
TEST_CASE("a pendulum under the midpoint rule neither rings across its joint nor opens it") {
  AnimationLoop loop{World{RigidBodies{}}, Constraints{BallJoint{}}, PositionProjection{.rate = 1},
                     ImplicitMidpoint{}, AcceleratedGaussSeidel{.tolerance = 1e-12}};
  auto& set = bodies<RigidBodies>(loop.world());
  const Vec3 arm(-1, 0, 0);
  const auto bob = set.add(
      {.position = -arm, .velocity = {0.1, 0, 0}, .mass = 1.0, .inertia = Mat3(0.01 * Mat3::Identity())});
  loop.add(BallJoint::Item{world_anchor({0, 0, 0}), anchor(set, bob, arm)});
  const double h = 0.01, rate = h * 27;
  double gap = 0, across = 0, off = 0;
  for (int n = 0; n < 50000; ++n) {
    const double now = loop.step(h).max_joint_violation;
    if (n < 200) continue;
    gap = std::max(gap, now);
    across = std::max(
        across, (set.velocity(bob) + set.angular_velocity(bob).cross(set.orientation(bob) * arm)).norm());
    off = std::max(off, std::abs(kinetic_energy(set) + potential_energy(set)));
  }
  CAPTURE(gap, across, off);
  CHECK(gap <= h * h * rate / 2 * 0.022);
  CHECK(across <= h * rate);
  CHECK(off <= 0.01 * 9.81);
}

// What the rows of the middle see goes to zero where they pass the straight line, and what those of the start
// see does not: a fade that asks for it there parts the joints by up to 1 m. A step lets the rods fall at g h
// across and turn by h · g h/(1/2 m); where they come back from three of those a joint opens by ½ θ² · 1 m.
TEST_CASE("two rods drawn straight between two hooks keep their joints under the midpoint rule") {
  const double h = 0.01, turn = h * 3 * 9.81 * h / 0.5;
  for (const double slack : {0.0, 1e-10, 1e-9, 3e-9, 5e-8}) {
    AnimationLoop loop{World{RigidBodies{}}, Constraints{BallJoint{}}, PositionProjection{.rate = 1},
                       ImplicitMidpoint{}};
    auto& set = bodies<RigidBodies>(loop.world());
    const double angle = std::acos(1 - slack);
    const auto rod = [&](double x, double sign) {
      return set.add({.position = {x, 0, -std::sin(angle) / 2},
                      .orientation = exponential<double>({0, sign * angle, 0}),
                      .mass = 1.0,
                      .inertia = Mat3(Vec3(0.01, 0.002, 0.01).asDiagonal())});
    };
    const auto left = rod((1 - slack) / 2, 1), right = rod(3 * (1 - slack) / 2, -1);
    loop.add(BallJoint::Item{world_anchor({0, 0, 0}), anchor(set, left, {-0.5, 0, 0})});
    loop.add(BallJoint::Item{anchor(set, left, {0.5, 0, 0}), anchor(set, right, {-0.5, 0, 0})});
    loop.add(BallJoint::Item{world_anchor({2 * (1 - slack), 0, 0}), anchor(set, right, {0.5, 0, 0})});
    double gap = 0;
    for (int n = 0; n < 1000; ++n) gap = std::max(gap, loop.step(h).max_joint_violation);
    CAPTURE(slack, gap);
    CHECK(gap <= turn * turn / 2);
  }
}

// The rods cross the line between the hooks again and again. Where the middle of a step is near it, its rows
// are blind to what the gap asks for, or see it the other way round: a displacement by them threw the rods up
// by half a metre, and what should fade grew. Gaps as above, with the push on top. Joints that withhold that do
// no work: what the rods have is the fall of the first step, whose rows see nothing across, m (g h)²/2 each.
TEST_CASE("two rods drawn straight and pushed across keep their joints and gain one step's fall at most") {
  for (const double h : {1e-2, 1e-3})
    for (const double push : {0.0, 1e-6, 1e-3}) {
      AnimationLoop loop{World{RigidBodies{}}, Constraints{BallJoint{}}, PositionProjection{.rate = 1},
                         ImplicitMidpoint{}, DirectGaussSeidel{}};
      auto& set = bodies<RigidBodies>(loop.world());
      const auto rod = [&](double x, double speed) {
        return set.add({.position = {x, 0, 0},
                        .velocity = {0, speed, 0},
                        .mass = 1.0,
                        .inertia = Mat3(Vec3(1e-3, 1. / 12, 1. / 12).asDiagonal())});
      };
      const auto left = rod(0.5, push), right = rod(1.5, -push);
      loop.add(BallJoint::Item{world_anchor({0, 0, 0}), anchor(set, left, {-0.5, 0, 0})});
      loop.add(BallJoint::Item{anchor(set, left, {0.5, 0, 0}), anchor(set, right, {-0.5, 0, 0})});
      loop.add(BallJoint::Item{world_anchor({2, 0, 0}), anchor(set, right, {0.5, 0, 0})});
      const double start = kinetic_energy(set) + potential_energy(set);
      double gap = 0, gain = 0;
      for (int n = 0; n < 5 / h; ++n) {
        gap = std::max(gap, loop.step(h).max_joint_violation);
        gain = std::max(gain, kinetic_energy(set) + potential_energy(set) - start);
      }
      const double turn = h * (3 * 9.81 * h + push) / 0.5;
      CAPTURE(h, push, gap, gain);
      CHECK(gap <= turn * turn / 2);
      CHECK(gain <= 2 * 0.5 * (9.81 * h) * (9.81 * h));
    }
}

// The joint is closed to rounding, the stop is not: what pushes it back is no part of what closes joints.
TEST_CASE("a hinge that begins beyond its stop is pushed back to it under the midpoint rule") {
  AnimationLoop loop{World{RigidBodies{}}, Constraints{Hinge{}, Limit<Turn>{}}, ImplicitMidpoint{},
                     PositionProjection{.rate = 1}};
  auto& set = bodies<RigidBodies>(loop.world());
  set.gravity.setZero();
  const Quat turn = exponential<double>(Vec3(0, 0, 0.3));
  const Vec3 pivot(0.1, 0.2, 0.3);
  const auto body = set.add({.orientation = turn, .mass = 1.0, .shape = Box{1, 0.2, 0.2}});
  const Anchor post = world_anchor(pivot), leaf = anchor(set, body, turn.inverse() * pivot);
  loop.add(Hinge::Item{post, leaf});
  const auto stop = loop.add(Limit<Turn>::Item{.a = post, .b = leaf, .lower = -1, .upper = 0.1});
  for (int n = 0; n < 100; ++n) loop.step(0.01);
  CHECK(loop.item(stop).position == Approx(0.1).margin(1e-6));  // the solver's tolerance, of speeds below 1 rad/s
}

// What is withheld of an island and how far it is displaced are its own: 200 steps, in many of which the rods'
// displacement is cut.
TEST_CASE("a pendulum beside two rods drawn straight goes as it does alone, to the bit") {
  const auto swing = [](bool is_alone) {
    AnimationLoop loop{World{RigidBodies{}}, Constraints{BallJoint{}}, PositionProjection{.rate = 1},
                       ImplicitMidpoint{}, DirectGaussSeidel{}};
    auto& set = bodies<RigidBodies>(loop.world());
    const auto rod = [&](double x, double y) {
      return set.add(
          {.position = {x, y, 0}, .mass = 1.0, .inertia = Mat3(Vec3(1e-3, 1. / 12, 1. / 12).asDiagonal())});
    };
    const auto bob = rod(0.5, 5);
    loop.add(BallJoint::Item{world_anchor({0, 5, 0}), anchor(set, bob, {-0.5, 0, 0})});
    if (!is_alone) {
      const auto left = rod(0.5, 0), right = rod(1.5, 0);
      loop.add(BallJoint::Item{world_anchor({0, 0, 0}), anchor(set, left, {-0.5, 0, 0})});
      loop.add(BallJoint::Item{anchor(set, left, {0.5, 0, 0}), anchor(set, right, {-0.5, 0, 0})});
      loop.add(BallJoint::Item{world_anchor({2, 0, 0}), anchor(set, right, {0.5, 0, 0})});
    }
    for (int n = 0; n < 200; ++n) loop.step(0.01);
    return std::pair{set.position(bob), set.velocity(bob)};
  };
  const auto alone = swing(true), beside = swing(false);
  CHECK(beside.first == alone.first);
  CHECK(beside.second == alone.second);
}
