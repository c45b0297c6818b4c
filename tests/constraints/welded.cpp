// Two boxes welded to one, and joints in single precision.
#include <delassus/delassus.hpp>

#include <algorithm>
#include <cmath>
#include <vector>

#include "catch.hpp"

namespace welded_tests {

using namespace delassus;

namespace {

/// Where a body of two boxes is after a second of free flight with spin, welded from two or made as one.
Pose flight(bool is_welded, double h) {
  AnimationLoop loop{World{RigidBodies{}}, Constraints{Weld{}}, ImplicitMidpoint{},
                     PositionProjection{.rate = 1}, AcceleratedGaussSeidel{.tolerance = 1e-13}};
  auto& rigid = bodies<RigidBodies>(loop.world());
  const Vec3 spin(0.7, 1.1, -0.4), v(0.3, 0, 1);
  const double m = 1.5;  // each of 1 × 0.5 × 0.4 m, side by side along x
  const Vec3 inertia = m / 12 * Vec3(0.25 + 0.16, 1 + 0.16, 1 + 0.25);
  RigidBodies::Handle one;
  if (is_welded) {
    const auto half = [&](double x) {
      return rigid.add({.position = {x, 0, 0},
                        .velocity = v + spin.cross(Vec3(x, 0, 0)),
                        .angular_velocity = spin,
                        .mass = m,
                        .inertia = Mat3(inertia.asDiagonal())});
    };
    one = half(-0.5);
    const auto two = half(0.5);
    loop.add(Weld::Item{anchor(rigid, one, {0.5, 0, 0}), anchor(rigid, two, {-0.5, 0, 0})});
  } else {
    const Vec3 steiner = 2 * inertia + 2 * m * 0.25 * Vec3(0, 1, 1);
    one = rigid.add(
        {.velocity = v, .angular_velocity = spin, .mass = 2 * m, .inertia = Mat3(steiner.asDiagonal())});
  }
  for (int n = 0; n < int(1 / h + 0.5); ++n) loop.step(h);
  const Vec3 arm = is_welded ? Vec3(0.5, 0, 0) : Vec3(0, 0, 0);
  return {rigid.position(one) + rigid.orientation(one) * arm, rigid.orientation(one).toRotationMatrix()};
}

}  // namespace

// The weld sees the mean rates of the boxes, of which the guess of the gyroscopic term is off by h² α ω a step, α = |Ω × IΩ|/I about
// 1 rad/s² here: for a second, so second order with a constant below 1. The centre of mass flies exactly; the weld's own gap is
// (h ω)² r/2 = 5e-7 m.
TEST_CASE("two boxes welded together fly as the one body that they are, to second order in the step") {
  std::vector<double> error;
  for (const double h : {4e-3, 2e-3, 1e-3}) {
    const Pose welded = flight(true, h), single = flight(false, h);
    CHECK((welded.position - single.position).norm() <= 2 * 0.5 * h * h);
    error.push_back((welded.rotation - single.rotation).norm());
  }
  CAPTURE(error[0], error[1], error[2]);
  CHECK(error[2] <= 1e-6);
  for (int k = 0; k < 2; ++k) {
    CHECK(std::log2(error[k] / error[k + 1]) >= 1.9);
    CHECK(std::log2(error[k] / error[k + 1]) <= 2.1);
  }
}

TEST_CASE("joints, a motor and a limit work in single precision") {
  AnimationLoop loop{World{RigidBodiesF{}}, Constraints{Hinge{}, Motor<Turn>{}, Limit<Turn>{}},
                     AcceleratedGaussSeidel{.tolerance = 1e-5}};
  auto& rigid = bodies<RigidBodiesF>(loop.world());
  const auto door = rigid.add({.position = {0.5, 0, 0}, .mass = 10.0, .shape = Box{1, 0.05, 2}});
  const Anchor frame = world_anchor(Vec3::Zero()), leaf = anchor(rigid, door, {-0.5, 0, 0});
  loop.add(Hinge::Item{frame, leaf});
  const auto motor = loop.add(Motor<Turn>::Item{.a = frame, .b = leaf, .speed = 1, .max_force = 20});
  loop.add(Limit<Turn>::Item{.a = frame, .b = leaf, .upper = 1.5});
  double gap = 0;
  for (int n = 0; n < 400; ++n) {
    const StepReport report = loop.step(0.01);
    REQUIRE(report.quarantined == 0);
    gap = std::max(gap, report.max_joint_violation);
  }
  // (h ω)² L/2 a step, five times it by Baumgarte's 0.2, and 1e-5 of the weight's rate h g over its 0.2/h.
  CHECK(gap <= 5 * 0.5 * 1e-4 * 0.5 + 1e-4);
  CHECK(std::abs(loop.item(motor).position - 1.5) <= 1e-3);
}

}  // namespace welded_tests
