// Machines of files keep their energy where nothing takes it.
#include <delassus/adapters/mjcf.hpp>
#include <delassus/delassus.hpp>
#include <delassus/model/add.hpp>
#include <delassus/model/joint_state.hpp>
#include <delassus/steppers/newton_midpoint.hpp>

#include "catch.hpp"

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <random>
#include <string>
#include <vector>

namespace mjcf_energy_tests {

using namespace delassus;

namespace {

/// Kinetic, with rotors; and with it weight and springs of joints.
struct Energy {
  double kinetic, all;
};
Energy energy_of(const auto& loop, const Machine& machine, const Model& model) {
  const auto& set = bodies<RigidBodies>(loop.world());
  double kinetic = kinetic_energy(set), springs = 0;
  for (std::size_t j = 0; j < model.joints.size(); ++j) {
    const model::Joint& joint = model.joints[j];
    if (joint.kind == model::JointKind::ball || joint.kind == model::JointKind::free) continue;
    const double rate = joint.armature > 0 ? rate_of(loop.world(), machine, Index(j)) : 0;
    const double past =
        joint.stiffness > 0 ? position_of(loop.world(), machine, Index(j)) - joint.spring_reference : 0;
    kinetic += joint.armature / 2 * rate * rate;
    springs += joint.stiffness / 2 * past * past;
  }
  return {kinetic, kinetic + springs + potential_energy(set)};
}

/// The largest change of energy in a second, as a share of the kinetic energy at the start.
double lost(const Model& model, double h) {
  AnimationLoop loop{World{RigidBodies{}},
                     Constraints{Hinge{}, Slider{}, BallJoint{}, SerialJoint<0, 2>{}, SerialJoint<0, 3>{},
                                 SerialJoint<2, 0>{}, SerialJoint<2, 1>{}, SpringDamper<Turn>{},
                                 SpringDamper<Slide>{}, SpringDamper<Precession>{}, SpringDamper<Nutation>{},
                                 SpringDamper<Spin>{}, RotorInertia<Turn>{}, RotorInertia<Slide>{},
                                 RotorInertia<Precession>{}, RotorInertia<Nutation>{}, RotorInertia<Spin>{}},
                     NewtonMidpoint{.tolerance = 1e-13}};
  const Machine machine = add(loop, model, {}, Base::as_file,
                              {.contacts = true,
                               .limits = true,
                               .damping = true,
                               .friction_loss = true,
                               .couplings = true,
                               .actuators = true});
  bodies<RigidBodies>(loop.world()).gravity = model.gravity;
  JointSpace space(model);
  std::vector<double> q(std::size_t(space.q_size())), v(std::size_t(space.v_size()));
  space.reference(q);
  std::mt19937 random(5);
  std::uniform_real_distribution<double> draw(-1, 1);
  for (std::size_t j = 0; j < model.joints.size(); ++j)
    if (model.joints[j].kind == model::JointKind::hinge || model.joints[j].kind == model::JointKind::slide)
      q[std::size_t(space.q_of(Index(j)))] += 0.3 * draw(random);
  for (double& x : v) x = draw(random);
  set_joint_state(loop, machine, space, q, v);
  const Energy start = energy_of(loop, machine, model);
  double most = 0;
  for (long n = std::lround(1 / h); n > 0; --n) {
    loop.step(h);
    most = std::max(most, std::abs(energy_of(loop, machine, model).all - start.all) / start.kinetic);
  }
  return most;
}

}  // namespace

// Joints are quadratic in the rotations, weight is linear, and springs and rotors store what they take: the
// rule keeps their energy to what Newton's method leaves. That is 1e-13 a step of what changes hands in it,
// 1e-10 in a second.
TEST_CASE("machines of MJCF files keep their energy without damping and friction") {
  const char* folder = std::getenv("DELASSUS_MODELS");
  if (!folder) {
    WARN("DELASSUS_MODELS does not name the folder of models: skipped");
    return;
  }
  const std::string at = std::string(folder) + "/mjcf/";
  for (const char* name :
       {"dm_control/acrobot",   "dm_control/ball_in_cup", "dm_control/cartpole",  "dm_control/cheetah",
        "dm_control/finger",    "dm_control/hopper",      "dm_control/humanoid",  "dm_control/manipulator",
        "dm_control/pendulum",  "dm_control/point_mass",  "dm_control/quadruped", "dm_control/reacher",
        "dm_control/stacker",   "dm_control/swimmer",     "dm_control/walker",    "mujoco/arm26",
        "mujoco/car",           "mujoco/carousel",        "mujoco/dominos",       "mujoco/humanoid",
        "mujoco/newton_cradle", "mujoco/slider_crank",    "mujoco/treadmill"}) {
    CAPTURE(name);
    CHECK(lost(read_mjcf(at + name + ".xml", {.strict = false, .files = {at + "mujoco"}}), 1e-3) < 1e-8);
  }
}

}  // namespace mjcf_energy_tests
