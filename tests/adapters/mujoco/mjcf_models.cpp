// The files that MuJoCo 2.2.2 reads, as it reads them.
#include "same_model.hpp"

#include <delassus/adapters/mjcf.hpp>

namespace mujoco_mjcf_models_tests {

using namespace delassus;

namespace {

void check_file(const std::string& path) {
  CAPTURE(path);
  const Model model = read_mjcf(path);
  const MujocoModel m = load_in_mujoco(path);
  check_bodies(model, *m);
  check_joints(model, *m);
  check_geoms(model, *m);
  check_tendons(model, *m);
  check_actuators(model, *m);
  check_rest(model, *m);
}

}  // namespace

TEST_CASE("masses, joints, shapes, tendons, actuators and equalities of 18 files are those of MuJoCo 2.2.2") {
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

}  // namespace mujoco_mjcf_models_tests
