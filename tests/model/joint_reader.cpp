// q and v of a machine in a loop: what is read is what was set, and setting what is read changes nothing.
#include <delassus/delassus.hpp>
#include <delassus/constraints/joints/rotor_inertia.hpp>
#include <delassus/constraints/joints/spring_damper.hpp>
#include <delassus/model/add.hpp>
#include <delassus/model/joint_reader.hpp>
#include <delassus/model/joint_state.hpp>
#include <delassus/solvers/direct_gauss_seidel.hpp>
#include <delassus/stabilisation/closed_joints.hpp>

#include "catch.hpp"

#include <algorithm>
#include <cmath>
#include <vector>

namespace joint_reader_tests {

using namespace delassus;

namespace {

/// A body on a free joint, a rod on a ball joint of it, a rod with a rotor on a hinge of that, and a weld on its end.
Model chain_of_kinds() {
  using enum model::JointKind;
  Model model{.name = "chain"};
  model.gravity = {0, 0, -9.81};
  const model::JointKind kinds[] = {free, ball, hinge};
  for (int k = 0; k < 4; ++k) {
    model.bodies.push_back({.name = "body " + std::to_string(k),
                            .parent = Index(k - 1),
                            .pose = {Vec3(0, 0.1 * k, k == 0 ? 0. : -0.8), rotation_matrix(unit(Quat(1, 0.1 * k, 0.2, 0)))},
                            .mass = 1 + 0.3 * k,
                            .centre = {0.05 * k, 0.1, -0.3},
                            .inertia = Mat3(Vec3(0.1, 0.12, 0.03 + 0.02 * k).asDiagonal()),
                            .gravity_compensation = 0.2});
    if (k == 3) break;
    model.bodies.back().joints = {Index(k)};
    model.joints.push_back({.name = "joint " + std::to_string(k), .kind = kinds[k], .axis = {0, 0.6, 0.8}, .damping = 0.3, .stiffness = k == 2 ? 2. : 0, .armature = k == 2 ? 0.1 : 0});
  }
  return model;
}

auto loop_of_kinds() {
  return AnimationLoop{World{RigidBodies{}}, Constraints{BallJoint{}, Hinge{}, RotorInertia<Turn>{}, SpringDamper<Turn>{}}, DirectGaussSeidel{.tolerance = 1e-13}, ClosedJoints{.tolerance = 1e-11}};
}

const std::vector<double> q0{0.3, -0.2, 1, 0.8, 0.6, 0, 0, 0.6, 0, 0.8, 0, 0.4}, v0{0.5, -1, 2, 1, -2, 0.5, 3, -4, 2, 5};

double apart(const std::vector<double>& a, const std::vector<double>& b) {
  double most = 0;
  for (std::size_t k = 0; k < a.size(); ++k) most = std::max(most, std::abs(a[k] - b[k]));
  return most;
}

}  // namespace

TEST_CASE("joints of every kind are read as they were set") {
  const Model model = chain_of_kinds();
  auto loop = loop_of_kinds();
  Machine machine = add(loop, model);
  JointReader reader(model);
  std::vector<double> q(q0.size()), v(v0.size());
  reader.space().reference(q);
  set_joint_state(loop, machine, reader.space(), q0, v0);
  reader.read(loop, machine, q, v);
  CHECK(apart(q, q0) < 1e-13);
  CHECK(apart(v, v0) < 1e-12);
  CHECK((reader.poses()[3].position - pose_of(bodies<RigidBodies>(loop.world()), machine, 3).position).norm() < 1e-15);
}

// The bodies end a step with rates that no v has, by h times the Coriolis acceleration. With the rates between them in the place
// of v each step would lose that acceleration, however small it is.
TEST_CASE("a machine that is set to what was read goes on as it would") {
  const Model model = chain_of_kinds();
  auto untouched = loop_of_kinds(), set_anew = loop_of_kinds();
  Machine first = add(untouched, model), second = add(set_anew, model);
  JointReader reader(model);
  set_joint_state(untouched, first, reader.space(), q0, v0);
  set_joint_state(set_anew, second, reader.space(), q0, v0);
  std::vector<double> q = q0, v = v0, q_untouched = q0, v_untouched = v0;
  for (int n = 0; n < 500; ++n) {
    untouched.step(1e-3), set_anew.step(1e-3);
    reader.read(set_anew, second, q, v);
    set_joint_state(set_anew, second, reader.space(), q, v);
    reader.read(untouched, first, q_untouched, v_untouched);
  }
  CHECK(apart(q_untouched, q0) > 0.5);
  CHECK(apart(q, q_untouched) < 1e-8);
  CHECK(apart(v, v_untouched) < 1e-7);
}

// The rotor keeps a rate of its own from step to step.
TEST_CASE("a machine that is set after a run moves like a new one, its rotor too") {
  const Model model = chain_of_kinds();
  auto used = loop_of_kinds(), fresh = loop_of_kinds();
  Machine first = add(used, model), second = add(fresh, model);
  JointReader reader(model);
  set_joint_state(used, first, reader.space(), q0, std::vector<double>(v0.size(), 1));
  for (int n = 0; n < 100; ++n) used.step(1e-3);
  set_joint_state(used, first, reader.space(), q0, v0);
  set_joint_state(fresh, second, reader.space(), q0, v0);
  for (int n = 0; n < 100; ++n) used.step(1e-3), fresh.step(1e-3);
  std::vector<double> q_used = q0, v_used = v0, q_fresh = q0, v_fresh = v0;
  reader.read(used, first, q_used, v_used);
  reader.read(fresh, second, q_fresh, v_fresh);
  CHECK(apart(q_fresh, q0) > 0.1);
  CHECK(apart(v_used, v_fresh) < 1e-10);
}

// Momentum of a chain in flight without weight: Σ m v and what v says of it are one and the same.
TEST_CASE("v has the momentum of the bodies") {
  Model model = chain_of_kinds();
  model.joints[2].armature = 0;
  auto loop = loop_of_kinds();
  bodies<RigidBodies>(loop.world()).gravity = zero<Vec3>();
  Machine machine = add(loop, model);
  JointReader reader(model);
  set_joint_state(loop, machine, reader.space(), q0, v0);
  for (int n = 0; n < 50; ++n) loop.step(2e-3);
  std::vector<double> q = q0, v(v0.size());
  reader.read(loop, machine, q, v);
  Vec3 bodies_have = zero<Vec3>(), joints_have = zero<Vec3>();
  double differ = 0;
  std::vector<Vec<6>> velocities(model.bodies.size());
  reader.space().velocities(q, v, velocities);
  for (std::size_t b = 0; b < model.bodies.size(); ++b) {
    const Vec3 arm = reader.poses()[b].rotation * model.bodies[b].centre;
    const auto of_centre = [&](const Vec<6>& x) { return Vec3(model.bodies[b].mass * Vec3(linear_part(x) + cross(angular_part(x), arm))); };
    bodies_have += of_centre(reader.velocities()[b]), joints_have += of_centre(velocities[b]);
    differ = std::max(differ, (velocities[b] - reader.velocities()[b]).norm());
  }
  CHECK(differ > 1e-4);  // else nothing is shown
  CHECK((bodies_have - joints_have).norm() < 1e-12);
}

TEST_CASE("a reader refuses the machine of another model") {
  const Model model = chain_of_kinds();
  Model shorter = model;
  shorter.bodies.pop_back();
  auto loop = loop_of_kinds();
  const Machine machine = add(loop, model);
  JointReader reader(shorter);
  std::vector<double> q = q0, v = v0;
  CHECK_THROWS_AS(reader.read(loop, machine, q, v), InvalidArgument);
}

}  // namespace joint_reader_tests
