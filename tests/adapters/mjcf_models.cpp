// Models of other projects: each reads, and has the parts that it is known for.
#include <delassus/adapters/mjcf.hpp>

#include "catch.hpp"

#include <algorithm>
#include <cstdlib>
#include <filesystem>
#include <map>

namespace mjcf_models_tests {

using namespace delassus;

namespace {

/// Bodies, joints by kind, geoms, tendons, actuators, couplings, keys.
struct Counts {
  std::size_t bodies, free, hinges, slides, geometries, tendons, actuators, couplings, keys;
  bool operator==(const Counts&) const = default;
};

Counts counts_of(const Model& m) {
  const auto joints = [&](model::JointKind kind) {
    return std::size_t(std::count_if(m.joints.begin(), m.joints.end(),
                                     [&](const model::Joint& j) { return j.kind == kind; }));
  };
  return {m.bodies.size(),
          joints(model::JointKind::free),
          joints(model::JointKind::hinge),
          joints(model::JointKind::slide),
          m.geometries.size(),
          m.tendons.size(),
          m.actuators.size(),
          m.couplings.size(),
          m.keyframes.size()};
}

const std::map<std::string, Counts> known = {
    {"dm_control/acrobot", {2, 0, 2, 0, 4, 0, 1, 0, 0}},
    {"dm_control/ball_in_cup", {2, 0, 0, 4, 7, 1, 2, 0, 0}},
    {"dm_control/cartpole", {2, 0, 1, 1, 5, 0, 1, 0, 0}},
    {"dm_control/cheetah", {7, 0, 7, 2, 9, 0, 6, 0, 0}},
    {"dm_control/finger", {3, 0, 3, 0, 8, 0, 2, 0, 0}},
    {"dm_control/hopper", {5, 0, 5, 2, 7, 0, 4, 0, 0}},
    {"dm_control/humanoid", {16, 1, 21, 0, 20, 0, 21, 0, 0}},
    {"dm_control/manipulator", {16, 0, 10, 4, 34, 2, 5, 1, 0}},
    {"dm_control/pendulum", {1, 0, 1, 0, 4, 0, 1, 0, 0}},
    {"dm_control/point_mass", {1, 0, 0, 2, 7, 2, 2, 0, 0}},
    {"dm_control/quadruped", {18, 2, 16, 0, 26, 12, 12, 4, 0}},
    {"dm_control/reacher", {3, 0, 2, 0, 10, 0, 2, 0, 0}},
    {"dm_control/stacker", {14, 0, 12, 8, 24, 2, 5, 1, 0}},
    {"dm_control/swimmer", {1, 0, 1, 2, 7, 0, 0, 0, 0}},
    {"dm_control/walker", {7, 0, 7, 2, 8, 0, 6, 0, 0}},
    {"mujoco/arm26", {2, 0, 2, 0, 5, 0, 0, 0, 0}},
    {"mujoco/car", {3, 1, 2, 0, 5, 2, 2, 0, 0}},
    {"mujoco/carousel", {6, 6, 0, 0, 60, 0, 0, 0, 0}},
    {"mujoco/dominos", {96, 96, 0, 0, 97, 0, 0, 0, 0}},
    {"mujoco/humanoid", {16, 1, 21, 0, 20, 2, 21, 0, 4}},
    {"mujoco/newton_cradle", {7, 7, 0, 0, 8, 14, 0, 0, 0}},
    {"mujoco/slider_crank", {3, 0, 3, 0, 7, 0, 0, 0, 0}},
    {"mujoco/treadmill", {16, 1, 21, 0, 32, 2, 21, 0, 4}},
};

/// Files that are refused, and the sentence that says why: none.
const std::map<std::string, std::string> refused = {};

Model read_model(const std::string& folder, const std::string& name) {
  // treadmill attaches ../humanoid/humanoid.xml, which is not there; the one beside it serves.
  return read_mjcf(folder + "/mjcf/" + name + ".xml", {.files = {folder + "/mjcf/mujoco"}});
}

}  // namespace

TEST_CASE("every MJCF file of other projects reads, with the parts that it has") {
  const char* folder = std::getenv("DELASSUS_MODELS");
  if (!folder) {
    WARN("DELASSUS_MODELS is not set: no models of other projects are read");
    return;
  }
  for (const char* group : {"dm_control", "mujoco"})
    for (const auto& file : std::filesystem::directory_iterator(std::string(folder) + "/mjcf/" + group)) {
      if (file.path().extension() != ".xml") continue;
      const std::string name = std::string(group) + "/" + file.path().stem().string();
      CAPTURE(name);
      if (const auto reason = refused.find(name); reason != refused.end()) {
        CHECK_THROWS_WITH(read_model(folder, name), Catch::Contains(reason->second));
        continue;
      }
      const Model m = read_model(folder, name);
      if (known.count(name) == 1) CHECK(counts_of(m) == known.at(name));
    }
}

TEST_CASE("slider_crank and arm26 say what was left out of them") {
  const char* folder = std::getenv("DELASSUS_MODELS");
  if (!folder) return;
  const Model crank = read_model(folder, "mujoco/slider_crank");
  REQUIRE(crank.skipped.size() == 3);
  CHECK_THAT(crank.skipped[0], Catch::Contains("slider_crank.xml:50: the actuator 'forward' (position) is "
                                               "left out: its transmission is a slider and crank"));
  const Model arm = read_model(folder, "mujoco/arm26");
  REQUIRE(arm.skipped.size() == 12);
  CHECK_THAT(
      arm.skipped[0],
      Catch::Contains("arm26.xml:69: the tendon 'SF' is left out: it wraps around the geom 'shoulder'"));
  CHECK_THAT(arm.skipped[6], Catch::Contains("arm26.xml:111: the actuator 'SF' (muscle) is left out"));
}

}  // namespace mjcf_models_tests
