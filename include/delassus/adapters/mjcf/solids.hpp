/// Mass and moments of the shapes of geoms, filled or as shells.
#pragma once

#include <delassus/geometry/inertia.hpp>

#include <algorithm>
#include <array>
#include <cstddef>

namespace delassus::inner::mjcf {

enum class GeomType { plane, hfield, sphere, capsule, ellipsoid, cylinder, box, mesh, sdf };

/// Half sizes as MJCF has them, m.
using Sizes = std::array<double, 3>;

/// Per density: of a filled shape, or of a shell of density 1 kg/m².
inline MassProperties filled(GeomType type, const Sizes& s) {
  switch (type) {
    case GeomType::sphere:
      return unit_solid(Sphere{s[0]});
    case GeomType::capsule:
      return unit_solid(Capsule{s[0], 2 * s[1]});
    case GeomType::cylinder:
      return unit_solid(Cylinder{s[0], 2 * s[1]});
    case GeomType::ellipsoid:
      return unit_solid(Ellipsoid{s[0], s[1], s[2]});
    case GeomType::box:
    case GeomType::hfield:
      return unit_solid(Box{2 * s[0], 2 * s[1], 2 * s[2]});
    default:
      return {};
  }
}

/// Adds a part's mass and diagonal moments, each about the whole's centre.
inline void add_part(MassProperties& to, double mass, double xx, double yy, double zz) {
  to.mass += mass;
  to.inertia(0, 0) += xx;
  to.inertia(1, 1) += yy;
  to.inertia(2, 2) += zz;
}

inline MassProperties sphere_shell(double r) {
  const double m = 4 * pi * r * r, i = 2.0 / 3 * m * r * r;
  return solid(m, i, i, i);
}

/// An open tube.
inline MassProperties tube(double r, double half) {
  const double m = 4 * pi * r * half, across = m * (r * r / 2 + half * half / 3);
  return solid(m, across, across, m * r * r);
}

/// Two half-spheres, whose own centres lie r/2 beyond the ends of the tube.
inline MassProperties capsule_shell(double r, double half) {
  MassProperties p = tube(r, half);
  const MassProperties ball = sphere_shell(r);
  const double across = ball.inertia(0, 0) + ball.mass * (half * half + half * r);
  add_part(p, ball.mass, across, across, ball.inertia(2, 2));
  return p;
}

inline MassProperties cylinder_shell(double r, double half) {
  MassProperties p = tube(r, half);
  const double disk = pi * r * r, across = disk * (r * r / 4 + half * half);
  add_part(p, 2 * disk, 2 * across, 2 * across, disk * r * r);
  return p;
}

inline MassProperties box_shell(const Sizes& s) {
  MassProperties p;
  for (int k = 0; k < 3; ++k) {  // the two sides across axis k
    const int i = (k + 1) % 3, j = (k + 2) % 3;
    const double m = 8 * s[std::size_t(i)] * s[std::size_t(j)];
    std::array<double, 3> square;  // mean squares of the coordinates
    for (int axis = 0; axis < 3; ++axis)
      square[std::size_t(axis)] = s[std::size_t(axis)] * s[std::size_t(axis)] / (axis == k ? 1 : 3);
    add_part(p, m, m * (square[1] + square[2]), m * (square[2] + square[0]), m * (square[0] + square[1]));
  }
  return p;
}

/// Thomsen's formula for the surface, and for the moments the difference to an ellipsoid whose half axes are
/// 1e-6 m longer: what MuJoCo takes.
inline MassProperties ellipsoid_shell(const Sizes& s) {
  const double p = 1.6075;
  const double sum = std::pow(s[0] * s[1], p) + std::pow(s[1] * s[2], p) + std::pow(s[2] * s[0], p);
  const MassProperties in = unit_solid(Ellipsoid{s[0], s[1], s[2]}),
                       out = unit_solid(Ellipsoid{s[0] + 1e-6, s[1] + 1e-6, s[2] + 1e-6});
  MassProperties shell{.mass = 4 * pi * std::pow(sum / 3, 1 / p)};
  shell.inertia = shell.mass / (out.mass - in.mass) * (out.inertia - in.inertia);
  return shell;
}

inline MassProperties shell(GeomType type, const Sizes& s) {
  switch (type) {
    case GeomType::sphere:
      return sphere_shell(s[0]);
    case GeomType::capsule:
      return capsule_shell(s[0], s[1]);
    case GeomType::cylinder:
      return cylinder_shell(s[0], s[1]);
    case GeomType::ellipsoid:
      return ellipsoid_shell(s);
    case GeomType::box:
    case GeomType::hfield:
      return box_shell(s);
    default:
      return {};
  }
}

}  // namespace delassus::inner::mjcf
