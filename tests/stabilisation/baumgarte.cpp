#include <delassus/stabilisation/baumgarte.hpp>
#include <delassus/stabilisation/soft_contact.hpp>

#include "catch.hpp"
#include "stabilisation/violated.hpp"

using namespace delassus;

// φ₊ = φ + h u⁺ = (1 − rate) φ: a geometric series, each term rounded once.
TEST_CASE("Baumgarte takes its rate of a joint's violation back, each step") {
  for (const double rate : {0.1, 0.2, 0.5, 1.0}) {
    violated::Joint scene(Baumgarte{.rate = rate});
    double expected = 0.1;
    for (int n = 0; n < 30; ++n) {
      scene.loop.step(0.01);
      expected *= 1 - rate;
      CAPTURE(rate, n);
      REQUIRE(std::abs(scene.set().position(scene.bob).x() - expected) <= 1e-16);
    }
  }
}

TEST_CASE("Baumgarte does not depend on the step: the rate is per step") {
  for (const double h : {1e-4, 1e-2, 1.0}) {
    violated::Joint scene(Baumgarte{.rate = 0.2});
    scene.loop.step(h);
    CHECK(scene.set().position(scene.bob).x() == Approx(0.08).epsilon(1e-14));
  }
}

// 0.2 · 0.1/1e-4 = 200 m/s without a cap; the particle is brought at the cap's speed, from either side.
TEST_CASE("a joint is closed no faster than the cap, whatever the step") {
  const auto approaches_at = [](auto policy, double gap) {
    violated::Joint scene(policy, gap);
    scene.loop.step(1e-4);
    return scene.set().velocity(scene.bob).x();
  };
  for (const double gap : {-0.1, 0.1}) {
    const double back = gap > 0 ? -1 : 1;
    CHECK(approaches_at(Baumgarte{}, gap) == Approx(back * 200).epsilon(1e-12));
    CHECK(approaches_at(Baumgarte{.max_joint_speed = 3}, gap) == Approx(back * 3).epsilon(1e-12));
    CHECK(approaches_at(SoftContact{.max_joint_speed = 3}, gap) == Approx(back * 3).epsilon(1e-12));
  }
}

// A pendulum of 1 m whose steps alternate between 1e-4 s and 0.05 s: the long step opens the joint, the short one must not
// shoot the bob. It may fall by 1 m: √(2 g) = 4.43 m/s, and the cap is the most a step adds.
TEST_CASE("steps that jump by a factor of 500 do not shoot a pendulum away") {
  AnimationLoop loop{World{RigidBodies{}}, Constraints{BallJoint{}}, Baumgarte{.max_joint_speed = 10}};
  auto& set = bodies<RigidBodies>(loop.world());
  const auto bob = set.add({.position = {1, 0, 0}, .mass = 1.0, .shape = Sphere{0.1}});
  loop.add(BallJoint::Item{anchor(set, bob, {-1, 0, 0}), world_anchor({0, 0, 0})});
  double fastest = 0, farthest = 0;
  for (int n = 0; n < 2000; ++n) {
    loop.step(n % 2 ? 0.05 : 1e-4);
    fastest = std::max(fastest, set.velocity(bob).norm());
    farthest = std::max(farthest, set.position(bob).norm());
  }
  CHECK(fastest < 15);
  CHECK(farthest < 2);
}

TEST_CASE("an overlap shrinks by Baumgarte's rate, below the cap") {
  violated::Sunk scene(Baumgarte{.rate = 0.2, .max_speed = 1}, 0.01);
  const double h = 0.01;  // 0.2 · 0.01/0.01 = 0.2 m/s
  double expected = 0.01;
  for (int n = 0; n < 10; ++n) {
    scene.loop.step(h);
    expected *= 0.8;
    REQUIRE(scene.depth() == Approx(expected).epsilon(1e-9));  // 10 roundings of 0.5 m against 1e-3 m
  }
}

TEST_CASE("an overlap is pushed out no faster than Baumgarte's cap, whatever the step") {
  for (const double h : {1e-4, 1e-3, 1e-2}) {
    violated::Sunk scene(Baumgarte{.rate = 0.5, .max_speed = 0.3}, 0.2);
    CAPTURE(h);
    CHECK(scene.exit_speed(h, 50) == Approx(0.3).epsilon(1e-12));
  }
}
