#include <delassus/delassus.hpp>
#include <delassus/model/actuators.hpp>
#include <delassus/model/add.hpp>
#include <delassus/solvers/direct_gauss_seidel.hpp>

#include "catch.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <string>
#include <vector>

namespace actuators_tests {

using namespace delassus;
using Catch::Contains;

namespace {

/// Rods of 1 kg and 1 m that stand out along x from a hinge about y, one on the end of the other: weight
/// turns them to larger q.
Model arm(int links) {
  Model model{};
  model.name = "arm";
  for (int k = 0; k < links; ++k) {
    model::Joint joint;
    joint.name = "hinge " + std::to_string(k), joint.axis = {0, 1, 0};
    model.joints.push_back(joint);
    model::Body body;
    body.name = "rod " + std::to_string(k), body.parent = Index(k - 1),
    body.pose.position = {k == 0 ? 0. : 1., 0, 0};
    body.mass = 1, body.centre = {0.5, 0, 0}, body.inertia = Vec3(1e-3, 1. / 12, 1. / 12).asDiagonal(),
    body.joints = {Index(k)};
    model.bodies.push_back(body);
  }
  return model;
}
model::Actuator servo(const std::string& name, Index joint, double kp, double kv) {
  model::Actuator a;
  a.name = name, a.target = joint, a.gain = kp, a.bias = {0, -kp, -kv};
  return a;
}
auto loop_of(auto... laws) {
  AnimationLoop loop{World{RigidBodies{}}, Constraints{Hinge{}, laws...},
                     DirectGaussSeidel{.tolerance = 1e-12}};
  return loop;
}

}  // namespace

// At rest kp (u − q) + 9.81/2 cos q = 0.
TEST_CASE("a position actuator holds a rod against its weight with the droop of its gain") {
  for (const double gear : {1., -2.}) {
    Model model = arm(1);
    model.actuators = {servo("elbow", 0, 30, 6)};
    model.actuators[0].gear[0] = gear;
    auto loop = loop_of(SpringDamper<Turn>{});
    Machine machine = add(loop, model);
    CHECK(machine.left_out.empty());
    set_control(machine, "elbow", 0.3);
    for (int n = 0; n < 4000; ++n) actuate(loop, machine, 1e-2), loop.step(1e-2);
    const double q = position_of(loop.world(), machine, 0);
    CHECK(gear * 30 * (0.3 - gear * q) + 9.81 / 2 * std::cos(q) == Approx(0).margin(1e-6));
    CHECK(gear * actuator_force(loop.world(), machine, 0) == Approx(-9.81 / 2 * std::cos(q)).margin(1e-6));
  }
}

// Much stiffer than the step could follow by a force: kp h²/I = 3e5.
TEST_CASE("the stiffness of an actuator is implicit") {
  Model model = arm(2);
  model.actuators = {servo("shoulder", 0, 1e9, 0), servo("elbow", 1, 1e9, 0)};
  auto loop = loop_of(SpringDamper<Turn>{});
  Machine machine = add(loop, model);
  machine.controls = {0.4, -0.7};
  for (int n = 0; n < 500; ++n) actuate(loop, machine, 1e-2), loop.step(1e-2);
  CHECK(position_of(loop.world(), machine, 0) == Approx(0.4).margin(1e-6));
  CHECK(position_of(loop.world(), machine, 1) == Approx(-0.7).margin(1e-6));
}

// ȧ = (u − a)/τ has a(t) = u (1 − e^(−t/τ)), whatever the steps; the force is its mean over a step.
TEST_CASE("a filter follows its control exactly at any step") {
  for (const double h : {1e-3, 0.05, 0.5}) {
    Model model = arm(1);
    model.bodies[0].centre = zero<Vec3>();
    model::Actuator motor;
    motor.name = "m", motor.target = 0, motor.time_constant = 0.2, motor.control_is_limited = true,
    motor.control_lower = -1, motor.control_upper = 2;
    model.actuators = {motor};
    auto loop = loop_of();
    Machine machine = add(loop, model);
    auto& set = bodies<RigidBodies>(loop.world());
    set.gravity = zero<Vec3>();
    machine.controls[0] = 7;  // 2, as its range says
    for (int n = 0; n < std::lround(1 / h); ++n) actuate(loop, machine, h), loop.step(h);
    CHECK(machine.activations[0] == Approx(2 * -std::expm1(-1 / 0.2)).epsilon(1e-12));
    CHECK(rate_of(loop.world(), machine, 0) / 12 ==
          Approx(2 * (1 + 0.2 * std::expm1(-1 / 0.2))).epsilon(1e-9));  // I q̇ = ∫ a
  }
}

TEST_CASE("an actuator's cap need not be the same both ways") {
  for (const bool has_stiffness : {false, true}) {
    Model model = arm(1);
    if (has_stiffness)
      model.actuators = {servo("a", 0, 1e4, 10)};
    else
      model.actuators.emplace_back().target = 0;
    model.actuators[0].force_is_limited = true, model.actuators[0].force_lower = -3,
    model.actuators[0].force_upper = 1;
    for (const double control : {-1e3, 1e3}) {
      auto loop = loop_of(Drive<Turn>{});
      Machine machine = add(loop, model);
      bodies<RigidBodies>(loop.world()).gravity = zero<Vec3>();
      machine.controls[0] = control;
      const double h = 1e-3;
      actuate(loop, machine, h), loop.step(h);
      CAPTURE(has_stiffness, control);
      CHECK(rate_of(loop.world(), machine, 0) ==
            Approx(3 * h * (control < 0 ? -3 : 1)).epsilon(1e-6));  // 1/I = 3
    }
  }
}

TEST_CASE("a keyframe's controls and activations are taken") {
  Model model = arm(2);
  model.actuators = {servo("a", 0, 1, 0), servo("b", 1, 1, 0)};
  model.actuators[1].time_constant = 0.1;
  auto loop = loop_of(SpringDamper<Turn>{});
  Machine machine = add(loop, model);
  model::Keyframe key;
  key.activation = {0.7}, key.control = {0.2, 0.3};
  set_controls(machine, key);
  CHECK(machine.controls == std::vector<double>{0.2, 0.3});
  CHECK(machine.activations == std::vector<double>{0, 0.7});
  CHECK(actuator_force(loop.world(), machine, 1) == Approx(0.7));
}

TEST_CASE("what an actuator cannot do is said") {
  Model model = arm(1);
  model.actuators = {servo("a", 0, 1, 0)};
  auto bare = loop_of();
  CHECK_THROWS_WITH(add(bare, model), Contains("SpringDamper<Turn>{}"));
  Machine nothing = add(bare, model, {}, Base::as_file, {.actuators = true});
  nothing.controls[0] = 1e6;
  bodies<RigidBodies>(bare.world()).gravity = zero<Vec3>();
  actuate(bare, nothing, 1e-2), bare.step(1e-2);
  CHECK(rate_of(bare.world(), nothing, 0) == 0);
  CHECK(actuator_force(bare.world(), nothing, 0) == 0);
  auto loop = loop_of(SpringDamper<Turn>{});
  Machine machine = add(loop, model);
  CHECK_THROWS_WITH(set_control(machine, "b", 1), Contains("no actuator 'b'; it has 'a'"));
  CHECK_THROWS_WITH(actuator_force(loop.world(), machine, 1), Contains("no actuator 1"));
  CHECK_THROWS_WITH(actuate(loop, machine, 0), Contains("actuate: h"));
  machine.controls[0] = std::numeric_limits<double>::quiet_NaN();
  CHECK_THROWS_WITH(actuate(loop, machine, 1e-2), Contains("actuator 'a': its control is not finite"));

  Model ball = arm(1);
  ball.joints[0].kind = model::JointKind::ball;
  ball.actuators = {servo("a", 0, 1, 0)};
  AnimationLoop other{World{RigidBodies{}}, Constraints{BallJoint{}}};
  const Machine left = add(other, ball);
  REQUIRE(left.left_out.size() == 1);
  CHECK_THAT(left.left_out[0], Contains("actuator 'a' does not act: its joint is a ball or free"));
}

// Energy is fed in: q grows as cosh. The force is that of the middle of each step.
TEST_CASE("an actuator whose gain feeds energy in is a force") {
  Model model = arm(1);
  model.actuators = {servo("a", 0, 0, 0)};
  model.actuators[0].bias = {0.1, 3, 0};  // I q'' = 0.1 + 3 q, I = 1/3: q = (0.1/3) (cosh 3 t − 1)
  auto loop = loop_of();
  Machine machine = add(loop, model);
  bodies<RigidBodies>(loop.world()).gravity = zero<Vec3>();
  for (int n = 0; n < 1000; ++n) actuate(loop, machine, 1e-3), loop.step(1e-3);
  CHECK(position_of(loop.world(), machine, 0) == Approx(0.1 / 3 * (std::cosh(3) - 1)).epsilon(1e-2));
}

// Two tendons, one of them twice as long as the other from where they were; a limit, and an actuator that
// pulls them.
TEST_CASE("tendons of a model are coupled and stopped and driven") {
  Model model = arm(2);
  model.tendons.resize(2);
  model.tendons[0].name = "sum", model.tendons[0].joints = {{0, 1}, {1, 0.5}};
  model.tendons[1].name = "difference", model.tendons[1].joints = {{0, 1}, {1, -0.5}};
  model.tendons[0].is_limited = true, model.tendons[0].lower = -0.6, model.tendons[0].upper = 1;
  model::Coupling coupling;
  coupling.name = "both", coupling.joint = 0, coupling.other = 1, coupling.of_tendons = true,
  coupling.coefficients = {0.1, 2, 0, 0, 0};
  model.couplings = {coupling};
  model.actuators = {servo("pull", 1, 50, 20)};
  model.actuators[0].transmission = model::Transmission::tendon;
  auto loop = loop_of(Tendon<2>{}, TendonLimit<2>{});
  Machine machine = add(loop, model);
  CHECK(machine.left_out.empty());
  bodies<RigidBodies>(loop.world()).gravity = zero<Vec3>();
  const auto length = [&](double sign) {
    return position_of(loop.world(), machine, 0) + sign * 0.5 * position_of(loop.world(), machine, 1);
  };
  machine.controls[0] = 0.2;
  for (int n = 0; n < 3000; ++n) actuate(loop, machine, 5e-3), loop.step(5e-3);
  CHECK(length(-1) == Approx(0.2).margin(1e-6));
  CHECK(length(1) == Approx(0.1 + 2 * 0.2).margin(1e-6));
  machine.controls[0] = -3;
  for (int n = 0; n < 3000; ++n) actuate(loop, machine, 5e-3), loop.step(5e-3);
  CHECK(length(1) == Approx(-0.6).margin(1e-6));
  CHECK(length(-1) == Approx(-0.35).margin(1e-6));
}

// Two hinges of one body: no law of two joints holds them, a sum of both does.
TEST_CASE("a coupling of two hinges of one body acts") {
  Model model = arm(1);
  model.joints.push_back(model.joints[0]);
  model.joints[1].name = "swing", model.joints[1].axis = {0, 0, 1};
  model.bodies[0].joints = {0, 1};
  model::Coupling coupling;
  coupling.name = "both", coupling.joint = 1, coupling.other = 0,
  coupling.coefficients = {0.2, -0.5, 0, 0, 0};
  model.couplings = {coupling};
  AnimationLoop loop{World{RigidBodies{}}, Constraints{SerialJoint<0, 2>{}, Tendon<2>{}},
                     DirectGaussSeidel{.tolerance = 1e-12}};
  const Machine machine = add(loop, model);
  double most = 0, moved = 0;
  for (int n = 0; n < 1000; ++n) {
    loop.step(2e-3);
    const double q = position_of(loop.world(), machine, 0);
    moved = std::max(moved, std::abs(q));
    if (n > 100) most = std::max(most, std::abs(position_of(loop.world(), machine, 1) - 0.2 + 0.5 * q));
  }
  CHECK(moved > 1);
  CHECK(most < 1e-3);
}

TEST_CASE("the limit of a ball joint of a model acts") {
  Model model = arm(1);
  model.joints[0].kind = model::JointKind::ball;
  model.joints[0].is_limited = true, model.joints[0].upper = 0.4;
  AnimationLoop loop{World{RigidBodies{}}, Constraints{BallJoint{}, Limit<RotationAngle>{}},
                     DirectGaussSeidel{.tolerance = 1e-12}};
  const Machine machine = add(loop, model);
  CHECK(machine.left_out.empty());
  auto& set = bodies<RigidBodies>(loop.world());
  for (int n = 0; n < 1000; ++n) loop.step(2e-3);
  const Mat3 turned = pose_of(set, machine, 0).rotation;
  CHECK(std::acos((turned.trace() - 1) / 2) == Approx(0.4).margin(1e-4));  // hangs on its stop
}

}  // namespace actuators_tests
