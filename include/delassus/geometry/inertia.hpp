/// Mass, centre of mass and inertia of a solid of constant density.
#pragma once

#include <delassus/geometry/convex_hull.hpp>
#include <delassus/geometry/shape.hpp>

#include <concepts>
#include <string>
#include <type_traits>

namespace delassus {

/// What a rigid body takes of a solid.
struct MassProperties {
  double mass = 0;              ///< kg
  Vec3 centre = zero<Vec3>();   ///< of mass, body frame, m
  Mat3 inertia = zero<Mat3>();  ///< about the centre, axes of the body frame, kg·m²
};

namespace inner {

inline constexpr double pi = 3.14159265358979323846;

inline MassProperties solid(double mass, double xx, double yy, double zz) {
  MassProperties p{.mass = mass};
  p.inertia(0, 0) = xx;
  p.inertia(1, 1) = yy;
  p.inertia(2, 2) = zz;
  return p;
}

inline MassProperties unit_solid(const Sphere& s) {
  const double r2 = s.radius * s.radius, m = 4.0 / 3 * pi * r2 * s.radius, i = 0.4 * m * r2;
  return solid(m, i, i, i);
}

inline MassProperties unit_solid(const Box& b) {
  const double m = b.x * b.y * b.z, x = b.x * b.x, y = b.y * b.y, z = b.z * b.z;
  return solid(m, m / 12 * (y + z), m / 12 * (z + x), m / 12 * (x + y));
}

inline MassProperties unit_solid(const Cylinder& c) {
  const double r2 = c.radius * c.radius, m = pi * r2 * c.height,
               across = m * (r2 / 4 + c.height * c.height / 12);
  return solid(m, across, across, m * r2 / 2);
}

/// A cylinder and two half-balls of mass m₂/2, whose own centres lie 3r/8 beyond the ends of the segment.
inline MassProperties unit_solid(const Capsule& c) {
  const MassProperties rod = unit_solid(Cylinder{c.radius, c.height}), ball = unit_solid(Sphere{c.radius});
  const double half = c.height / 2, cap = 3.0 / 8 * c.radius;
  const double across = rod.inertia(0, 0) + ball.inertia(0, 0) + ball.mass * (half * half + 2 * half * cap);
  return solid(rod.mass + ball.mass, across, across, rod.inertia(2, 2) + ball.inertia(2, 2));
}

/// About its centre, a quarter of the height above the base.
inline MassProperties unit_solid(const Cone& c) {
  const double r2 = c.radius * c.radius, m = pi * r2 * c.height / 3,
               across = 3.0 / 80 * m * (4 * r2 + c.height * c.height);
  return solid(m, across, across, 0.3 * m * r2);
}

inline MassProperties unit_solid(const Ellipsoid& e) {
  const double m = 4.0 / 3 * pi * e.a * e.b * e.c, a = e.a * e.a, b = e.b * e.b, c = e.c * e.c;
  return solid(m, m / 5 * (b + c), m / 5 * (c + a), m / 5 * (a + b));
}

/// I = tr(S) 1 − S with the second moment S.
template <class Scalar>
MassProperties unit_solid(const BasicConvexHull<Scalar>& h) {
  const auto& S = h.second_moment();
  MassProperties p{.mass = h.volume(), .centre = h.centroid(), .inertia = -S};
  for (int k = 0; k < 3; ++k) p.inertia(k, k) += S(0, 0) + S(1, 1) + S(2, 2);
  return p;
}

/// Of density 1 kg/m³.
MassProperties unit_solid(const std::same_as<Shape> auto& s) {
  switch (s.kind) {
    case ShapeKind::sphere:
      return unit_solid(Sphere{s.size[0]});
    case ShapeKind::box:
      return unit_solid(Box{2 * s.size[0], 2 * s.size[1], 2 * s.size[2]});
    case ShapeKind::capsule:
      return unit_solid(Capsule{s.size[0], 2 * s.size[1]});
    case ShapeKind::cylinder:
      return unit_solid(Cylinder{s.size[0], 2 * s.size[1]});
    case ShapeKind::cone:
      return unit_solid(Cone{s.size[0], 2 * s.size[1]});
    case ShapeKind::ellipsoid:
      return unit_solid(Ellipsoid{s.size[0], s.size[1], s.size[2]});
    case ShapeKind::convex_hull:
      return unit_solid(*s.hull);
    default:
      return {};
  }
}

}  // namespace inner

/// Of `shape` filled with `density` (kg/m³). Pre: the shape has a volume.
template <class Scalar = double>
MassProperties mass_properties(const Shape& shape, std::type_identity_t<Scalar> density) {
  DELASSUS_EXPECT(shape.has_volume(),
                  std::string("a ") + name(shape.kind) +
                      " has no finite volume; give mass and inertia instead of a density");
  MassProperties result = inner::unit_solid(shape);
  result.mass *= density;
  result.inertia *= density;
  return result;
}

}  // namespace delassus
