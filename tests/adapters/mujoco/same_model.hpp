/// A model as MuJoCo compiles it, beside ours.
#pragma once

#include "catch.hpp"

#include <delassus/math/rotation.hpp>
#include <delassus/model/model.hpp>

#include <cstdlib>
#include <memory>
#include <string>
#include <vector>

#include <mujoco/mujoco.h>

namespace delassus {

using MujocoModel = std::unique_ptr<mjModel, void (*)(mjModel*)>;

inline MujocoModel load_in_mujoco(const std::string& path) {
  char error[1000] = "";
  MujocoModel m(mj_loadXML(path.c_str(), nullptr, error, sizeof error), mj_deleteModel);
  INFO(error);
  REQUIRE(m);
  return m;
}

inline Vec3 vector_at(const mjtNum* x, int i) { return {x[3 * i], x[3 * i + 1], x[3 * i + 2]}; }
inline Mat3 turn_at(const mjtNum* x, int i) {
  return rotation_matrix(unit(Quat(x[4 * i], x[4 * i + 1], x[4 * i + 2], x[4 * i + 3])));
}

/// Equal to 1e-9 of their size.
inline void check_same(double a, double b) {
  CHECK(std::abs(a - b) <= 1e-9 * std::max(std::abs(a), std::abs(b)));
}
/// Equal to 1e-9 of the larger of their size and `size`.
inline void check_same(const Vec3& a, const Vec3& b, double size = 0) {
  CAPTURE(transposed(a), transposed(b));
  CHECK(norm(Vec3(a - b)) <= 1e-9 * std::max(size, norm(b)));
}
inline void check_same(const Mat3& a, const Mat3& b) {
  CAPTURE(a, b);
  CHECK(norm(Mat3(a - b)) <= 1e-9 * norm(b));
}
inline void check_same(const Pose& a, const mjtNum* positions, const mjtNum* turns, int i) {
  check_same(a.position, vector_at(positions, i), 1e-3);
  check_same(a.rotation, turn_at(turns, i));
}

inline std::string name_of(const mjModel& m, int type, int i) {
  const char* name = mj_id2name(&m, type, i);
  return name ? name : "";
}

void check_bodies(const Model& model, const mjModel& m);
void check_joints(const Model& model, const mjModel& m);
void check_geoms(const Model& model, const mjModel& m);
void check_tendons(const Model& model, const mjModel& m);
void check_actuators(const Model& model, const mjModel& m);
void check_rest(const Model& model, const mjModel& m);

}  // namespace delassus
