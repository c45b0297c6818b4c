/// What a model's `compiler` says: units of angles, the order of Euler's angles, folders, and what becomes of
/// masses.
#pragma once

#include <delassus/adapters/mjcf/document.hpp>
#include <delassus/geometry/shape.hpp>
#include <delassus/math/pose.hpp>
#include <delassus/math/rotation.hpp>

#include <array>
#include <cctype>
#include <string>

namespace delassus::inner::mjcf {

enum class FromGeoms { never, always, where_no_inertial };

struct Compiler {
  double angle = 3.14159265358979323846 / 180;  ///< rad in a unit of the file
  std::string euler = "xyz";                    ///< small letters: axes that turn along
  bool auto_limits = true;
  FromGeoms inertia_from_geoms = FromGeoms::where_no_inertial;
  double lowest_group = 0, highest_group = 5;  ///< of the geoms that have a mass
  double least_mass = 0, least_inertia = 0;
  double total_mass = -1;  ///< > 0: all masses are scaled to it
  bool balance_inertia = false;
  bool fit_boxes = false;  ///< shapes fitted to meshes: to their bounds, not their inertia
  bool exact_mesh_inertia = false;
  bool strip_path = false;
  std::string mesh_folder, asset_folder;
};

inline void read(const Element& e, Compiler& c, Skipped& skipped) {
  if (const int k = e.choice("angle", {"radian", "degree"}); k >= 0) c.angle = k == 0 ? 1 : Compiler{}.angle;
  if (e.has("eulerseq")) {
    c.euler = e.text("eulerseq");
    bool is_good = c.euler.size() == 3;
    for (const char letter : c.euler)
      is_good = is_good && std::string("xyzXYZ").find(letter) != std::string::npos;
    if (!is_good) e.refuse("eulerseq '" + c.euler.substr(0, 40) + "' must be three letters out of xyzXYZ");
  }
  if (e.choice("coordinate", {"local", "global"}) == 1)
    e.refuse(
        "coordinate='global' is not read; save the model with MuJoCo 2.3.3, which makes its frames local");
  e.read("autolimits", c.auto_limits);
  if (const int k = e.choice("inertiafromgeom", {"false", "true", "auto"}); k >= 0)
    c.inertia_from_geoms = FromGeoms(k);
  std::array<double, 2> groups{c.lowest_group, c.highest_group};
  if (e.read("inertiagrouprange", groups, 2)) c.lowest_group = groups[0], c.highest_group = groups[1];
  e.read("boundmass", c.least_mass);
  e.read("boundinertia", c.least_inertia);
  e.read("settotalmass", c.total_mass);
  e.read("balanceinertia", c.balance_inertia);
  e.read("fitaabb", c.fit_boxes);
  e.read("exactmeshinertia", c.exact_mesh_inertia);
  e.read("strippath", c.strip_path);
  if (e.has("assetdir")) c.asset_folder = c.mesh_folder = e.text("assetdir");
  if (e.has("meshdir")) c.mesh_folder = e.text("meshdir");
  bool is_on = false;
  if (e.read("alignfree", is_on) && is_on)
    skipped.add(e, "alignfree: bodies keep the frames that the file gives them");
  if (is_on = false; e.read("fusestatic", is_on) && is_on)
    skipped.add(e, "fusestatic: bodies without joints stay bodies of their own");
  if (is_on = false; e.read("discardvisual", is_on) && is_on)
    skipped.add(e, "discardvisual: geoms that collide with nothing stay");
}

/// Euler's angles in the file's unit. Small letters turn about axes that turn along, large ones about fixed
/// axes.
inline Mat3 euler_rotation(const Vec3& angles, const Compiler& c) {
  Quat q(1, 0, 0, 0);
  for (int i = 0; i < 3; ++i) {
    const char letter = c.euler[std::size_t(i)];
    const int axis = std::tolower(letter) - 'x';
    const Quat turn = exponential<double>((c.angle * angles[i]) * unit_axis(axis));
    q = std::islower(letter) ? product(q, turn) : product(turn, q);
  }
  return rotation_matrix(unit(q));
}

/// The shortest turn of z to a direction.
inline Mat3 rotation_to(const Vec3& direction) {
  const Vec3 z = direction_of(direction), across(-z[1], z[0], 0);
  const double s = norm(across);
  const Vec3 axis = s < 1e-10 ? Vec3(1, 0, 0) : Vec3(across / s);
  return rotation_matrix(unit(exponential<double>(std::atan2(s, z[2]) * axis)));
}

/// The orientation that an element gives in one of five ways; false where it gives none.
inline bool read_orientation(const Element& e, const Compiler& c, Mat3& to) {
  int count = 0;
  for (const char* way : {"quat", "axisangle", "xyaxes", "zaxis", "euler"}) count += e.has(way);
  if (count > 1)
    e.refuse(std::string(e.name()) + " has " + std::to_string(count) + " orientations; give one");
  const auto direction = [&](const char* what, const Vec3& v) {
    if (!(norm(v) > 1e-14))
      e.refuse(std::string(what) + " of " + std::string(e.name()) + " is too short to be a direction");
    return direction_of(v);
  };
  std::array<double, 6> x{};
  Vec3 v;
  if (e.read("quat", std::span(x).first(4), 4)) {
    const double size =
        std::max(std::max(std::abs(x[0]), std::abs(x[1])), std::max(std::abs(x[2]), std::abs(x[3])));
    if (!(size > 0)) e.refuse("quat of " + std::string(e.name()) + " is zero; a turn by nothing is 1 0 0 0");
    to = rotation_matrix(unit(Quat(x[0] / size, x[1] / size, x[2] / size, x[3] / size)));
  } else if (e.read("axisangle", std::span(x).first(4), 4)) {
    to = rotation_matrix(
        unit(exponential<double>(c.angle * x[3] * direction("axisangle", {x[0], x[1], x[2]}))));
  } else if (e.read("xyaxes", x, 6)) {
    const Vec3 a = direction("the x axis", {x[0], x[1], x[2]}), y(x[3], x[4], x[5]);
    const Vec3 b = direction("the y axis", Vec3(direction_of(y) - dot(a, direction_of(y)) * a));
    to = columns(a, b, cross(a, b));
  } else if (e.read("zaxis", v)) {
    to = rotation_to(direction("zaxis", v));
  } else if (e.read("euler", v)) {
    to = euler_rotation(v, c);
  }
  return count > 0;
}

inline Pose product(const Pose& a, const Pose& b) {
  return {a.to_world(b.position), Mat3(a.rotation * b.rotation)};
}
inline Pose inverse_of(const Pose& a) { return a.to_local(Pose{}); }

}  // namespace delassus::inner::mjcf
