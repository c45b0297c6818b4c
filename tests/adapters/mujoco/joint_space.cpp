// Poses, inverse and forward dynamics, and mass matrices, as MuJoCo 2.2.2 has them: the files that it reads,
// in ten random states each.
#include "model/random_tree.hpp"
#include "same_model.hpp"
#include "scratch_path.hpp"

#include <delassus/adapters/mjcf.hpp>
#include <delassus/model/joint_space.hpp>

#include <filesystem>
#include <fstream>

namespace mujoco_joint_space_tests {

using namespace delassus;

namespace {

using MujocoData = std::unique_ptr<mjData, void (*)(mjData*)>;

std::vector<double> numbers(const mjtNum* x, Index count) { return {x, x + count}; }

/// All that is not the dynamics of a tree.
void leave_the_tree_alone(mjModel& m) {
  m.opt.disableflags |= mjDSBL_CONSTRAINT | mjDSBL_ACTUATION;
  m.opt.density = m.opt.viscosity = 0;
}

struct Sides {
  JointSpace& space;
  const mjModel& m;
  mjData& d;
};

void check_layout(const Sides& s) {
  REQUIRE(s.space.q_size() == s.m.nq);
  REQUIRE(s.space.v_size() == s.m.nv);
  for (int j = 0; j < s.m.njnt; ++j) {
    CHECK(s.space.q_of(j) == s.m.jnt_qposadr[j]);
    CHECK(s.space.v_of(j) == s.m.jnt_dofadr[j]);
  }
  std::vector<double> q(std::size_t(s.m.nq));
  s.space.reference(q);
  CHECK(difference(q, numbers(s.m.qpos0, s.m.nq)) <= 1e-12);
}

void check_poses(const Sides& s, const std::vector<double>& q, const std::vector<double>& v) {
  const std::size_t bodies = std::size_t(s.m.nbody - 1);
  std::vector<Pose> poses(bodies);
  std::vector<Vec<6>> velocities(bodies);
  s.space.poses(q, poses);
  s.space.velocities(q, v, velocities);
  for (std::size_t b = 0; b < bodies; ++b) {
    CHECK(norm(Vec3(poses[b].position - vector_at(s.d.xpos, int(b) + 1))) <= 1e-9);
    CHECK(norm(Mat3(poses[b].rotation - turn_at(s.d.xquat, int(b) + 1))) <= 1e-9);
    mjtNum twice[6];  // angular, linear
    mj_objectVelocity(&s.m, &s.d, mjOBJ_XBODY, int(b) + 1, twice, 0);
    const Vec<6> theirs = twist<double>(vector_at(twice, 1), vector_at(twice, 0));
    CHECK(norm(Vec<6>(velocities[b] - theirs)) <= 1e-9 * (1 + norm(theirs)));
  }
}

void check_dynamics(const Sides& s, const std::vector<double>& q, const std::vector<double>& v,
                    const std::vector<double>& a) {
  std::vector<double> tau(v.size()), forward(v.size()), H(v.size() * v.size()), theirs(H.size());
  mju_copy(s.d.qpos, q.data(), s.m.nq);
  mju_copy(s.d.qvel, v.data(), s.m.nv);
  mju_copy(s.d.qacc, a.data(), s.m.nv);
  mj_inverse(&s.m, &s.d);
  s.space.inverse_dynamics(q, v, a, tau);
  CHECK(difference(tau, numbers(s.d.qfrc_inverse, s.m.nv)) <= 1e-9 * largest(tau));

  check_poses(s, q, v);
  mj_fullM(&s.m, theirs.data(), s.d.qM);
  s.space.mass_matrix(q, H);
  CHECK(difference(H, theirs) <= 1e-9 * largest(H));

  mju_copy(s.d.qfrc_applied, tau.data(), s.m.nv);
  mj_forward(&s.m, &s.d);
  s.space.forward_dynamics(q, v, tau, forward);
  CHECK(difference(forward, numbers(s.d.qacc, s.m.nv)) <= 1e-9 * largest(forward));
  CHECK(difference(forward, a) <= 1e-9 * largest(a));
}

void check_file(const std::string& path) {
  CAPTURE(path);
  const Model model = read_mjcf(path);
  const MujocoModel m = load_in_mujoco(path);
  leave_the_tree_alone(*m);
  const MujocoData d(mj_makeData(m.get()), mj_deleteData);
  JointSpace space(model);
  const Sides sides{space, *m, *d};
  check_layout(sides);
  Dice dice{std::mt19937(1)};
  for (int k = 0; k < 10; ++k)
    check_dynamics(sides, random_q(space, dice, 1), random_numbers(dice, space.v_size(), 3),
                   random_numbers(dice, space.v_size(), 10));
}

/// `inside` is what stands within <mujoco>.
void check_text(const std::string& inside) {
  const std::string path = scratch_path("joint_space.xml").string();
  std::ofstream(path) << "<mujoco><compiler autolimits='true'/>" + inside + "</mujoco>";
  check_file(path);
  std::filesystem::remove(path);
}

}  // namespace

TEST_CASE("the dynamics of 18 files are those of MuJoCo 2.2.2") {
  const char* folder = std::getenv("DELASSUS_MODELS");
  if (!folder) {
    WARN("DELASSUS_MODELS is not set: no models of other projects are read");
    return;
  }
  for (const char* name :
       {"dm_control/acrobot", "dm_control/ball_in_cup", "dm_control/cartpole", "dm_control/cheetah",
        "dm_control/finger", "dm_control/hopper", "dm_control/humanoid", "dm_control/manipulator",
        "dm_control/pendulum", "dm_control/point_mass", "dm_control/quadruped", "dm_control/reacher",
        "dm_control/stacker", "dm_control/swimmer", "dm_control/walker", "mujoco/arm26", "mujoco/humanoid",
        "mujoco/slider_crank"})
    check_file(std::string(folder) + "/mjcf/" + name + ".xml");
}

TEST_CASE("balls, free joints and several joints of a body, with springs, are as in MuJoCo 2.2.2") {
  const std::string geom = "<geom type='box' size='0.1 0.2 0.3' pos='0.1 0.05 -0.1'/>";
  check_text(
      "<worldbody><body pos='1 2 3' euler='10 20 30'><joint type='ball' pos='0.1 0.2 -0.3' stiffness='3' "
      "damping='0.5' "
      "armature='0.1'/>" +
      geom +
      "<body pos='0.5 0 0' euler='40 0 10'><joint type='slide' axis='1 1 0' ref='0.2' "
      "stiffness='10' springref='0.4'/><joint type='slide' axis='0 1 1' pos='1 0 0'/><joint type='hinge' "
      "axis='1 0 2' "
      "pos='0 0.3 0' ref='30' armature='0.2' stiffness='5' springref='10'/>" +
      geom + "</body></body></worldbody>");
  check_text(
      "<worldbody><body pos='1 2 3' euler='10 20 30'><joint type='free' stiffness='3' damping='0.5' "
      "armature='0.1'/>" +
      geom +
      "<body pos='0.5 0 0'><joint type='hinge' axis='1 0 0'/><joint type='hinge' axis='0 1 0' pos='0 0 0.2'/>"
      "<joint type='hinge' axis='0 0 1' damping='1'/>" +
      geom + "<body pos='0 0 1'>" + geom + "</body></body></body></worldbody>");
}

}  // namespace mujoco_joint_space_tests
