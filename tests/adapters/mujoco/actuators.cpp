// Actuators beside MuJoCo: their forces on random states, and machines that they move.
#include "adapters/mujoco/same_model.hpp"
#include "scratch_path.hpp"

#include <delassus/adapters/mjcf.hpp>
#include <delassus/delassus.hpp>
#include <delassus/model/actuators.hpp>
#include <delassus/model/add.hpp>
#include <delassus/model/joint_state.hpp>
#include <delassus/solvers/direct_gauss_seidel.hpp>
#include <delassus/steppers/newton_midpoint.hpp>

#include <algorithm>
#include <cmath>
#include <fstream>
#include <random>
#include <string>
#include <vector>

namespace actuators_tests {

using namespace delassus;

namespace {

using Numbers = std::vector<double>;

/// Every way in which an actuator is read, on hinges, a slide, two hinges of one body, tendons of both kinds
/// and a site.
const char* const all_kinds = R"(<mujoco>
  <option gravity="0 0 -9.81" density="0" viscosity="0"/>
  <worldbody>
    <site name="post" pos="0.3 0.2 0.5"/>
    <body name="cart" pos="0 0 1">
      <joint name="rail" type="slide" axis="1 0 0" damping="1"/>
      <geom type="box" size=".1 .1 .05" density="500"/>
      <body name="arm" pos="0 0 0.1">
        <joint name="yaw" axis="0 0 1" armature="0.02"/><joint name="pitch" axis="0 1 0" ref="20"/>
        <geom type="capsule" fromto="0 0 0 .4 0 0" size=".03"/><site name="elbow" pos=".35 .05 0"/>
        <body name="hand" pos=".4 0 0">
          <joint name="wrist" axis="0 1 0" damping="0.05"/>
          <geom type="capsule" fromto="0 0 0 .3 0 .1" size=".03"/><site name="tip" pos=".3 0 .1" euler="20 40 0"/>
        </body>
      </body>
    </body>
  </worldbody>
  <tendon>
    <fixed name="sum"><joint joint="pitch" coef=".5"/><joint joint="wrist" coef="-2"/><joint joint="rail" coef="1.5"/></fixed>
    <spatial name="rope"><site site="post"/><site site="elbow"/><site site="tip"/></spatial>
    <spatial name="line"><site site="post"/><site site="tip"/></spatial>
  </tendon>
  <actuator>
    <motor joint="rail" gear="3" ctrllimited="true" ctrlrange="-.5 .5"/>
    <position joint="yaw" kp="4"/>
    <velocity joint="pitch" kv="0.3" gear="2"/>
    <general joint="rail" gear="2" gainprm="1" biastype="affine" biasprm=".3 .5 0"/>
    <general tendon="rope" gainprm="2" biastype="affine" biasprm=".5 -3 -.2"/>
    <motor tendon="rope" gear="-.5"/>
    <motor tendon="line" gear=".5"/>
    <motor site="tip" gear="1 -2 .5 .1 .2 -.3"/>
    <general joint="wrist" gear="-2" gainprm="1.5" biastype="affine" biasprm=".1 -.4 -.05" dyntype="filter" dynprm=".2"/>
    <general tendon="sum" gear="1.5" gainprm="2" biastype="affine" biasprm=".2 -1.5 -.1" dyntype="filter" dynprm=".05"/>
  </actuator>
</mujoco>)";

/// The same, with caps on what is stiff and on what is not.
const char* const capped_kinds = R"(<mujoco>
  <option gravity="0 0 0"/>
  <worldbody>
    <body><joint name="a" axis="0 1 0"/><geom type="capsule" fromto="0 0 0 .4 0 0" size=".03"/>
      <body pos=".4 0 0"><joint name="b" axis="0 1 0"/><geom type="capsule" fromto="0 0 0 .4 0 0" size=".03"/></body></body>
  </worldbody>
  <tendon><fixed name="sum"><joint joint="a" coef=".5"/><joint joint="b" coef="-2"/></fixed></tendon>
  <actuator>
    <position joint="a" kp="4" gear="-2" forcelimited="true" forcerange="-.3 .2"/>
    <motor joint="b" forcelimited="true" forcerange="-.1 .3"/>
    <velocity tendon="sum" kv="3" forcelimited="true" forcerange="-.2 .4"/>
  </actuator>
</mujoco>)";

std::string file_of(const std::string& name, const char* text) {
  const std::string path = scratch_path(name + ".xml");
  std::ofstream(path) << text;
  return path;
}

/// A state within 0.3 of the reference, rates to 1, and controls to `most`.
struct Scene {
  Model model;
  Numbers q, v, control, activation;

  Scene(const std::string& path, const mjModel& m, std::mt19937& random, double most)
      : model(read_mjcf(path)) {
    std::uniform_real_distribution<double> draw(-1, 1);
    q.assign(m.qpos0, m.qpos0 + m.nq);
    for (int j = 0; j < m.njnt; ++j)
      if (m.jnt_type[j] == mjJNT_HINGE || m.jnt_type[j] == mjJNT_SLIDE)
        q[std::size_t(m.jnt_qposadr[j])] += 0.3 * draw(random);
    for (int i = 0; i < m.nv; ++i) v.push_back(draw(random));
    for (int i = 0; i < m.nu; ++i) control.push_back(most * draw(random));
    for (int i = 0; i < m.na; ++i) activation.push_back(most * draw(random));
  }
  mjData* begin(const mjModel& m) const {
    mjData* d = mj_makeData(&m);
    std::copy(q.begin(), q.end(), d->qpos);
    std::copy(v.begin(), v.end(), d->qvel);
    std::copy(control.begin(), control.end(), d->ctrl);
    std::copy(activation.begin(), activation.end(), d->act);
    return d;
  }
  /// The machine in a loop, in this state.
  Machine add_to(auto& loop, const LeaveOut& leave_out) const {
    Machine machine = add(loop, model, {}, Base::as_file, leave_out);
    bodies<RigidBodies>(loop.world()).gravity = model.gravity;
    JointSpace space(model);
    set_joint_state(loop, machine, space, q, v);
    set_controls(machine,
                 {.name = {}, .time = 0, .q = {}, .v = {}, .activation = activation, .control = control});
    return machine;
  }
};

constexpr LeaveOut only_actuators{.contacts = true, .limits = true, .friction_loss = true, .couplings = true};

auto all_joints(auto... more) {
  return Constraints{Hinge{},
                     Slider{},
                     BallJoint{},
                     SerialJoint<0, 2>{},
                     SerialJoint<0, 3>{},
                     SerialJoint<2, 0>{},
                     SerialJoint<2, 1>{},
                     SpringDamper<Turn>{},
                     SpringDamper<Slide>{},
                     SpringDamper<Precession>{},
                     SpringDamper<Nutation>{},
                     SpringDamper<Spin>{},
                     SpringDamper<Length>{},
                     RotorInertia<Turn>{},
                     RotorInertia<Slide>{},
                     RotorInertia<Precession>{},
                     RotorInertia<Nutation>{},
                     RotorInertia<Spin>{},
                     Tendon<3>{},
                     more...};
}

}  // namespace

// Lengths and rates of both agree to some 1e-15 of the positions, forces to that times the gains, of which
// the largest is 1000.
TEST_CASE("forces of actuators are those of MuJoCo on random states") {
  std::vector<std::string> paths{file_of("all_kinds", all_kinds), file_of("capped_kinds", capped_kinds)};
  const char* folder = std::getenv("DELASSUS_MODELS");
  if (folder)
    for (const char* name :
         {"acrobot", "ball_in_cup", "cartpole", "cheetah", "finger", "hopper", "humanoid", "manipulator",
          "pendulum", "point_mass", "quadruped", "reacher", "stacker", "swimmer", "walker"})
      paths.push_back(std::string(folder) + "/mjcf/dm_control/" + name + ".xml");
  else
    WARN("DELASSUS_MODELS does not name the folder of models: two models alone");
  std::mt19937 random(3);
  int compared = 0;
  for (const std::string& path : paths) {
    CAPTURE(path);
    const MujocoModel m = load_in_mujoco(path);
    for (int trial = 0; trial < 5; ++trial) {
      const Scene scene(path, *m, random, 1.5);
      mjData* d = scene.begin(*m);
      mj_forward(m.get(), d);
      const Numbers theirs(d->actuator_force, d->actuator_force + m->nu);
      mj_deleteData(d);
      AnimationLoop loop{World{RigidBodies{}}, all_joints(Drive<Turn>{}, Drive<Slide>{}, TendonMotor<2>{}),
                         DirectGaussSeidel{}};
      const Machine machine = scene.add_to(loop, only_actuators);
      REQUIRE(machine.actuators.size() == theirs.size());
      for (std::size_t k = 0; k < theirs.size(); ++k, ++compared) {
        CAPTURE(trial, k);
        CHECK(std::abs(actuator_force(loop.world(), machine, Index(k)) - theirs[k]) <=
              1e-9 * std::max(1., std::abs(theirs[k])));
      }
    }
  }
  CHECK(compared >= 5 * 13);
}

namespace {

/// q of hinges and slides after `seconds`, by MuJoCo's RK4 of 1e-4 s, less where friction loss and limits
/// would act.
Numbers by_mujoco(const Scene& scene, mjModel& m, double seconds) {
  m.opt.disableflags |= mjDSBL_CONSTRAINT;
  m.opt.density = m.opt.viscosity = 0;
  m.opt.integrator = mjINT_RK4;
  m.opt.timestep = 1e-4;
  mjData* d = scene.begin(m);
  for (long n = std::lround(seconds / m.opt.timestep); n > 0; --n) mj_step(&m, d);
  Numbers q;
  for (int j = 0; j < m.njnt; ++j)
    if (m.jnt_type[j] == mjJNT_HINGE || m.jnt_type[j] == mjJNT_SLIDE) q.push_back(d->qpos[m.jnt_qposadr[j]]);
  mj_deleteData(d);
  return q;
}

template <class Loop>
double difference(Loop&& loop, const Scene& scene, const Numbers& truth, double seconds, double h) {
  Machine machine = scene.add_to(loop, only_actuators);
  for (long n = std::lround(seconds / h); n > 0; --n) actuate(loop, machine, h), loop.step(h);
  double most = 0;
  std::size_t next = 0;
  for (std::size_t j = 0; j < scene.model.joints.size(); ++j) {
    const auto kind = scene.model.joints[j].kind;
    if (kind != model::JointKind::hinge && kind != model::JointKind::slide) continue;
    const double past = position_of(loop.world(), machine, Index(j)) - truth[next++];
    most = std::max(most, std::abs(kind == model::JointKind::slide ? past : std::remainder(past, 2 * M_PI)));
  }
  REQUIRE(next == truth.size());
  return most;
}

}  // namespace

// Forces act as they are halfway through a step, springs and dampers by the mean of it, filters by their
// exact mean: all that is of second order, as free motion by NewtonMidpoint is. So the difference falls to a
// quarter with h/2; with the default integrator to a half.
TEST_CASE("machines that actuators move do as in MuJoCo") {
  const char* folder = std::getenv("DELASSUS_MODELS");
  std::vector<std::string> paths{file_of("all_kinds_move", all_kinds)};
  if (folder)
    for (const char* name : {"acrobot", "cartpole", "cheetah", "finger", "hopper", "humanoid", "pendulum",
                             "point_mass", "quadruped", "reacher", "swimmer", "walker"})
      paths.push_back(std::string(folder) + "/mjcf/dm_control/" + name + ".xml");
  else
    WARN("DELASSUS_MODELS does not name the folder of models: one model alone");
  std::mt19937 random(8);
  for (const std::string& path : paths) {
    CAPTURE(path);
    const MujocoModel m = load_in_mujoco(path);
    const Scene scene(path, *m, random, 0.2);
    const double seconds = 0.25;
    const Numbers truth = by_mujoco(scene, *m, seconds);
    const auto midpoint = [&] { return AnimationLoop{World{RigidBodies{}}, all_joints(), NewtonMidpoint{}}; };
    const auto euler = [&] {
      return AnimationLoop{World{RigidBodies{}}, all_joints(), DirectGaussSeidel{.tolerance = 1e-12}};
    };
    const double coarse = difference(midpoint(), scene, truth, seconds, 2e-3),
                 fine = difference(midpoint(), scene, truth, seconds, 1e-3);
    CHECK(fine < 1e-3);
    const double first = difference(euler(), scene, truth, seconds, 5e-4),
                 second = difference(euler(), scene, truth, seconds, 2.5e-4);
    if (fine > 1e-8) CHECK(coarse / fine == Approx(4).epsilon(0.1));
    if (second > 1e-8) CHECK(first / second == Approx(2).epsilon(0.1));
  }
}

// A force that reaches its cap has a kink, which costs an order: the default integrator's is the first, and
// stays it.
TEST_CASE("actuators with caps move a machine as in MuJoCo") {
  const std::string path = file_of("capped_kinds_move", capped_kinds);
  const MujocoModel m = load_in_mujoco(path);
  std::mt19937 random(2);
  int capped = 0;
  for (int trial = 0; trial < 3; ++trial) {
    const Scene scene(path, *m, random, 0.5);
    const Numbers truth = by_mujoco(scene, *m, 0.25);
    const auto loop = [] {
      return AnimationLoop{World{RigidBodies{}}, all_joints(Drive<Turn>{}, TendonMotor<2>{}),
                           DirectGaussSeidel{.tolerance = 1e-12}};
    };
    const double first = difference(loop(), scene, truth, 0.25, 5e-4),
                 second = difference(loop(), scene, truth, 0.25, 2.5e-4);
    CHECK(second < 2e-3);
    CHECK(first / second == Approx(2).epsilon(0.15));
    auto start = loop();
    const Machine machine = scene.add_to(start, only_actuators);
    for (const double cap : {-0.3, 0.2, -0.1, -0.2, 0.4})
      for (Index k = 0; k < 3; ++k) capped += actuator_force(start.world(), machine, k) == cap;
  }
  CHECK(capped >= 3);
}

}  // namespace actuators_tests
