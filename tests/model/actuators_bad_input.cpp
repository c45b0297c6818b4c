// What actuators and machines refuse, in one sentence, and that nothing has happened then.
#include "model/one_link.hpp"

#include <delassus/constraints/joints/rotation_angle.hpp>
#include <delassus/constraints/joints/tendon.hpp>
#include <delassus/model/joint_state.hpp>
#include <delassus/solvers/direct_gauss_seidel.hpp>

#include "catch.hpp"

#include <limits>
#include <string>
#include <vector>

namespace actuators_bad_input_tests {

using namespace delassus;
using Catch::Contains;

namespace {

constexpr double nan = std::numeric_limits<double>::quiet_NaN();

auto make() {
  return AnimationLoop{World{RigidBodies{}}, Constraints{Hinge{}, SpringDamper<Turn>{}, Drive<Turn>{}},
                       DirectGaussSeidel{.tolerance = 1e-9}};
}
/// A ball of 1 kg somewhere else.
RigidBodies::Handle stranger(RigidBodies& set) {
  RigidBody body;
  body.position = {7, 0, 0}, body.mass = 1, body.shape = Sphere{0.2};
  return set.add(body);
}

}  // namespace

TEST_CASE("an actuator whose body was removed pushes nobody in its place") {
  for (const bool is_servo : {false, true})
    for (const bool at_site : {false, true}) {
      auto loop = make();
      auto& set = weightless(loop);
      Model model = one_link(20, {0, is_servo ? -20. : 0, 0});
      if (at_site) model.actuators[0].transmission = model::Transmission::site;
      Machine machine = add(loop, model);
      loop.remove(machine.parts[0].body);
      const auto other = stranger(set);
      REQUIRE(other.index == machine.parts[0].body.index);
      machine.controls[0] = 1;
      CAPTURE(is_servo, at_site);
      CHECK_THROWS_WITH(actuate(loop, machine, 1e-2),
                        Contains("actuate: actuator 'motor'") && Contains("was removed"));
      CHECK_THROWS_WITH(actuator_force(loop.world(), machine, 0),
                        Contains("actuator 'motor'") && Contains("was removed"));
      CHECK_THROWS_WITH(push_joint(loop, machine, 0, 20),
                        Contains("push_joint: joint 0") && Contains("was removed"));
      CHECK_THROWS_WITH(position_of(loop.world(), machine, 0), Contains("was removed"));
      CHECK_THROWS_WITH(rate_of(loop.world(), machine, 0), Contains("was removed"));
      loop.step(1e-2);
      CHECK(set.angular_velocity(other) == zero<Vec3>());
      CHECK(set.velocity(other) == zero<Vec3>());
    }
}

TEST_CASE("a machine in another loop is refused, an empty one too") {
  for (const bool is_empty : {true, false})
    for (const bool is_servo : {false, true}) {
      auto loop = make(), second = make();
      Machine machine = add(loop, one_link(20, {0, is_servo ? -20. : 0, 0}));
      auto& set = weightless(second);
      if (!is_empty) stranger(set);
      machine.controls[0] = 1;
      const auto says = Contains("this loop does not have the bodies of this machine");
      CHECK_THROWS_WITH(actuate(second, machine, 1e-2), says);
      CHECK_THROWS_WITH(actuator_force(second.world(), machine, 0), says);
      CHECK_THROWS_WITH(push_joint(second, machine, 0, 1), says);
      CHECK_THROWS_WITH(position_of(second.world(), machine, 0), says);
      JointSpace space(one_link());
      const std::vector<double> q{0.1}, v{0};
      CHECK_THROWS_WITH(set_joint_state(second, machine, space, q, v), says);
    }
}

TEST_CASE("a joint and a link that a machine does not have are refused") {
  auto loop = make();
  const Machine machine = add(loop, one_link());
  const auto& set = bodies<RigidBodies>(loop.world());
  CHECK_THROWS_WITH(pose_of(set, machine, 1), Contains("pose_of: this machine has no body 1"));
  CHECK_THROWS_WITH(pose_of(set, machine, -1), Contains("no body -1"));
  CHECK_THROWS_WITH(push_joint(loop, machine, 0, nan), Contains("push_joint: force nan must be finite"));
  CHECK(set.load(0).norm() == 0);
}

// A clone has the bodies: the machine drives both.
TEST_CASE("a machine drives a clone of its loop, and the loop where it was moved") {
  auto loop = make();
  weightless(loop);
  Machine machine = add(loop, one_link(20));
  auto twin = loop.clone();
  machine.controls[0] = 1;
  actuate(twin, machine, 1e-2), twin.step(1e-2);
  CHECK(rate_of(twin.world(), machine, 0) == Approx(20 * 1e-2 / 0.2));
  CHECK(rate_of(loop.world(), machine, 0) == 0);
  auto moved = std::move(loop);
  actuate(moved, machine, 1e-2), moved.step(1e-2);
  CHECK(rate_of(moved.world(), machine, 0) == Approx(20 * 1e-2 / 0.2));
}

TEST_CASE("actuate does all or nothing") {
  Model model = one_link(1, {0, 0, 0}, 0.1);
  model.actuators.push_back(model.actuators[0]);
  model.actuators[1].name = "second";
  const auto refuses = [&](auto spoil, const char* sentence) {
    auto loop = make();
    auto& set = weightless(loop);
    Machine machine = add(loop, model);
    machine.controls = {1, 1};
    spoil(machine, loop);
    const std::vector<double> before = machine.activations;
    CHECK_THROWS_WITH(actuate(loop, machine, 1e-2), Contains(sentence));
    CHECK(set.load(0).norm() == 0);
    for (std::size_t k = 0; k < before.size() && k < 1; ++k) CHECK(machine.activations[k] == before[k]);
  };
  refuses([](Machine& m, auto&) { m.controls[1] = nan; }, "actuator 'second': its control is not finite");
  refuses([](Machine& m, auto&) { m.activations[1] = nan; },
          "actuator 'second': its activation is not finite");
  refuses([](Machine& m, auto&) { m.controls.clear(); }, "0 controls and 2 activations");
  refuses([](Machine& m, auto&) { m.activations.push_back(0); }, "2 controls and 3 activations");
  model.actuators[1].gain = 1e50, model.actuators[1].time_constant = 0;
  refuses([](Machine& m, auto&) { m.controls[1] = 1e300; },
          "actuator 'second': its control makes a force that is not finite");
  model.actuators[1].bias = {0, -1, 0};
  refuses([](Machine& m, auto&) { m.controls[1] = 1e300; },
          "actuator 'second': its control makes a force that is not finite");
  refuses(
      [](Machine& m, auto& loop) {
        const auto& of = m.actuators[1].constraint;
        loop.remove(ConstraintHandle<SpringDamper<Turn>>{of.index, of.generation, of.owner});
      },
      "actuator 'second': its constraint was removed");
}

TEST_CASE("controls and keyframes of another size are refused, and change nothing") {
  auto loop = make();
  Machine machine = add(loop, one_link(20, {0, 0, 0}, 1));
  set_control(machine, "motor", 3);
  model::Keyframe key;
  key.name = "home";
  key.control = {1, 2, 3};
  CHECK_THROWS_WITH(set_controls(machine, key),
                    Contains("keyframe 'home' has 3 controls, and the machine 1"));
  key.control = {1}, key.activation = {1, 2};
  CHECK_THROWS_WITH(set_controls(machine, key),
                    Contains("keyframe 'home' has 2 activations, and the machine 1"));
  key.activation = {nan};
  CHECK_THROWS_WITH(set_controls(machine, key),
                    Contains("one of the activations of keyframe 'home' is not finite"));
  CHECK(machine.controls[0] == 3);
  machine.controls.clear();
  key.activation = {0.5};
  CHECK_THROWS_WITH(set_controls(machine, key), Contains("0 controls and 1 activations"));
  CHECK_THROWS_WITH(set_control(machine, "motor", 1), Contains("0 controls and 1 activations"));
  CHECK_THROWS_WITH(actuator_force(loop.world(), machine, 0), Contains("0 controls and 1 activations"));
}

// Of each law of a machine one number that it does not take, beside whole bodies and joints.
TEST_CASE("what a law refuses is refused before anything of the machine is added") {
  AnimationLoop loop{World{RigidBodies{}},
                     Constraints{Hinge{}, BallJoint{}, SpringDamper<Turn>{}, Drive<Turn>{},
                                 RotorInertia<Turn>{}, Limit<RotationAngle>{}, Tendon<1>{}}};
  auto& set = bodies<RigidBodies>(loop.world());
  const auto refuses = [&](const Model& model, const char* who, const char* what) {
    CHECK_THROWS_WITH(add(loop, model), Contains("add: model 'arm'") && Contains(who) && Contains(what));
    CHECK(set.blocks() == 0);
  };
  for (const double k : {1e-30, 1e30})
    refuses(one_link(1, {0, -k, 0}), "actuator 'motor'", "SpringDamper: stiffness");
  refuses(one_link(1, {0, 0, -1e-30}), "actuator 'motor'", "SpringDamper: damping");
  Model geared = one_link(1, {0, -1, 0});
  geared.actuators[0].gear[0] = 1e-12;
  refuses(geared, "actuator 'motor'", "stiffness 1e-24");
  Model joint = one_link();
  joint.joints[0].stiffness = 1e-30;
  refuses(joint, "joint 'hinge'", "SpringDamper: stiffness");
  joint.joints[0].stiffness = 0, joint.joints[0].armature = 1e30;
  refuses(joint, "joint 'hinge'", "RotorInertia: inertia");
  Model ball = one_link();
  ball.joints[0].kind = model::JointKind::ball, ball.joints[0].is_limited = true;
  ball.joints[0].lower = -2, ball.joints[0].upper = -1;
  refuses(ball, "joint 'hinge'", "must lie in [0, pi]");
  Model rope = one_link();
  model::Tendon tendon;
  tendon.name = "rope", tendon.joints = {{0, 2}}, tendon.stiffness = 1e30;
  rope.tendons = {tendon};
  refuses(rope, "tendon 'rope'", "Tendon: stiffness");
  Model heavy = one_link();
  heavy.bodies[0].inertia = Vec3(0.1, 0.1, 5).asDiagonal();
  refuses(heavy, "body 'link'", "triangle inequality");
}

// No turn is larger than pi: the stop is never met.
TEST_CASE("a ball joint whose limit is beyond half a turn has no stop") {
  Model model = one_link();
  model.joints[0].kind = model::JointKind::ball, model.joints[0].is_limited = true, model.joints[0].upper = 4;
  AnimationLoop loop{World{RigidBodies{}}, Constraints{BallJoint{}}};
  CHECK(add(loop, model).left_out.empty());
}

}  // namespace actuators_bad_input_tests
