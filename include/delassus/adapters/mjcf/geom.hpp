/// Geoms and sites: what they say, the frame in which they stand, and what they weigh.
#pragma once

#include <delassus/adapters/mjcf/field.hpp>
#include <delassus/adapters/mjcf/limits.hpp>
#include <delassus/adapters/mjcf/mesh.hpp>
#include <delassus/adapters/mjcf/solids.hpp>
#include <delassus/model/model.hpp>

#include <array>
#include <functional>
#include <optional>
#include <string>

namespace delassus::inner::mjcf {

/// Where a geom or a site stands: by a position and an orientation, or from one point to another.
struct Placement {
  Vec3 position = zero<Vec3>();
  Mat3 rotation = identity<Mat3>();
  bool has_ends = false;
  std::array<double, 6> ends{};
};

inline void read(const Element& e, const Compiler& c, Placement& p) {
  e.read("pos", p.position);
  read_orientation(e, c, p.rotation);
  if (e.read("fromto", p.ends, 6)) p.has_ends = true;
}

/// What `geom` says.
struct GeomSpec {
  GeomType type = GeomType::sphere;
  Placement placement;
  Sizes size{0, 0, 0};
  int contype = 1, conaffinity = 1, condim = 3, group = 0, priority = 0;
  std::array<double, 3> friction{1, 0.005, 0.0001};
  std::optional<double> mass;
  double density = 1000;
  bool is_shell = false;
  std::array<double, 6> surface{};
  double fit_scale = 1;
  std::string mesh, field;
};

inline GeomType read_type(const Element& e, GeomType otherwise) {
  const int k = e.choice(
      "type", {"plane", "hfield", "sphere", "capsule", "ellipsoid", "cylinder", "box", "mesh", "sdf"});
  return k < 0 ? otherwise : GeomType(k);
}

inline void read(const Element& e, const Compiler& c, GeomSpec& s, Skipped& skipped) {
  s.type = read_type(e, s.type);
  read(e, c, s.placement);
  e.read("size", s.size, 1);
  e.read("contype", s.contype);
  e.read("conaffinity", s.conaffinity);
  e.read("condim", s.condim);
  e.read("group", s.group);
  e.read("priority", s.priority);
  e.read("friction", s.friction, 1);
  if (double mass = 0; e.read("mass", mass)) s.mass = mass;
  e.read("density", s.density);
  e.read("shellinertia", s.is_shell);
  e.read("surfacevel", s.surface, 1);
  e.read("fitscale", s.fit_scale);
  s.mesh = e.text("mesh", s.mesh.c_str());
  s.field = e.text("hfield", s.field.c_str());
  skip_softness(e, skipped);
  skip_number(e, "margin", "contacts begin where surfaces meet", skipped);
  skip_number(e, "gap", "contacts begin where surfaces meet", skipped);
  skip_number(e, "adhesion", "surfaces do not stick", skipped);
  if (e.choice("fluidshape", {"none", "ellipsoid"}) == 1) skipped.add(e, "fluidshape: there is no fluid");
}

/// A placement in the frame of the body; of one from end to end the half length goes to `size`.
inline Pose place(const Element& e, const Placement& p, GeomType type, Sizes& size) {
  if (!p.has_ends) return {p.position, p.rotation};
  if (type != GeomType::capsule && type != GeomType::cylinder && type != GeomType::ellipsoid &&
      type != GeomType::box)
    e.refuse("fromto is for a capsule, a cylinder, an ellipsoid or a box");
  if (!is_zero(p.position)) e.refuse("both pos and fromto are given, here or in its class; give one");
  const Vec3 a(p.ends[0], p.ends[1], p.ends[2]), b(p.ends[3], p.ends[4], p.ends[5]);
  size[1] = norm(Vec3(a - b)) / 2;
  if (!(size[1] > 1e-14)) e.refuse("the two points of fromto are one");
  if (type == GeomType::ellipsoid || type == GeomType::box) {
    size[2] = size[1];
    size[1] = size[0];
  }
  return {Vec3(0.5 * (a + b)), rotation_to(Vec3(a - b))};
}

/// How many numbers of `size` a type has.
inline int size_count(GeomType type) {
  switch (type) {
    case GeomType::sphere:
      return 1;
    case GeomType::capsule:
    case GeomType::cylinder:
      return 2;
    case GeomType::ellipsoid:
    case GeomType::box:
      return 3;
    default:
      return 0;
  }
}

inline model::GeometryShape shape_of(GeomType type, const Sizes& s) {
  switch (type) {
    case GeomType::sphere:
      return Sphere{s[0]};
    case GeomType::capsule:
      return Capsule{s[0], 2 * s[1]};
    case GeomType::cylinder:
      return Cylinder{s[0], 2 * s[1]};
    case GeomType::ellipsoid:
      return Ellipsoid{s[0], s[1], s[2]};
    case GeomType::box:
      return Box{2 * s[0], 2 * s[1], 2 * s[2]};
    default:
      return model::Plane{};
  }
}

/// Sizes of a type that fits a mesh: by the box of its moments, or by its bounds in its principal axes. The
/// pose is of the shape in the frame of the mesh.
inline Pose fit_to_mesh(const Element& e, GeomType type, const LoadedMesh& loaded, const model::Mesh& mesh,
                        bool to_bounds, double scale, Sizes& size) {
  const PrincipalMoments p = principal_moments(loaded.solid.inertia);
  Pose pose{loaded.solid.centre, p.axes};
  std::array<double, 3> half;
  if (!to_bounds) {
    for (int k = 0; k < 3; ++k)
      half[std::size_t(k)] =
          0.5 *
          std::sqrt(6 * std::max(0.0, trace(loaded.solid.inertia) - 2 * p.moments[k]) / loaded.solid.mass);
  } else {
    Vec3 low(1e300, 1e300, 1e300), high = -low;
    for (const Vec3& v : mesh.vertices) {
      const Vec3 x = pose.to_local(v);
      for (int k = 0; k < 3; ++k) low[k] = std::min(low[k], x[k]), high[k] = std::max(high[k], x[k]);
    }
    for (int k = 0; k < 3; ++k) half[std::size_t(k)] = (high[k] - low[k]) / 2;
    pose.position = pose.to_world(Vec3(0.5 * (low + high)));
  }
  const double across = to_bounds ? std::max(half[0], half[1]) : (half[0] + half[1]) / 2;
  if (type == GeomType::sphere)
    size[0] = to_bounds ? std::max(across, half[2]) : (half[0] + half[1] + half[2]) / 3;
  else if (type == GeomType::capsule)
    size = {across, to_bounds ? half[2] - across : std::max(0.0, half[2] - across / 2), size[2]};
  else if (type == GeomType::cylinder)
    size = {across, half[2], size[2]};
  else if (type == GeomType::ellipsoid || type == GeomType::box)
    size = half;
  else
    e.refuse("only a sphere, capsule, cylinder, ellipsoid or box can be fitted to a mesh");
  for (double& s : size) s *= scale;
  return pose;
}

/// What the friction and the filters of a geom are.
inline void set_contact(const Element& e, const GeomSpec& s, model::Geometry& g) {
  if (s.condim != 1 && s.condim != 3 && s.condim != 4 && s.condim != 6)
    e.refuse("condim " + std::to_string(s.condim) + " must be 1, 3, 4 or 6");
  for (const double f : s.friction) expect_not_below_zero(e, "friction", f);
  g.contact_freedoms = s.condim;
  g.friction = s.friction[0];
  g.spinning_friction = s.friction[1];
  g.rolling_friction = s.friction[2];
  g.type = unsigned(s.contype);
  g.affinity = unsigned(s.conaffinity);
  g.priority = s.priority;
  g.surface_velocity = {s.surface[0], s.surface[1], s.surface[2]};
  g.surface_spin = {s.surface[3], s.surface[4], s.surface[5]};
}

/// Scales what a density of 1 gives to the geom's mass.
inline MassProperties weigh(const Element& e, const GeomSpec& s, MassProperties solid) {
  expect_not_below_zero(e, "density", s.density);
  if (s.mass) expect_not_below_zero(e, "mass", *s.mass);
  const double density = s.mass ? (solid.mass > 1e-14 ? *s.mass / solid.mass : 0) : s.density;
  solid.mass *= density;
  solid.inertia *= density;
  return solid;
}

}  // namespace delassus::inner::mjcf
