/// The surface point of a simple shape nearest to a given point, with its sign: what spheres need of the
/// others.
#pragma once

#include <delassus/collision/epa.hpp>
#include <delassus/collision/inner/nearest_ellipsoid.hpp>
#include <delassus/geometry/shape.hpp>

#include <concepts>

namespace delassus::inner {

/// Where the shape offers no direction (its centre, its axis), the one nearest to `wish` is taken.
NearestSurface nearest_surface_of_ball(double radius, const std::same_as<Vec3> auto& p, const Vec3& wish) {
  const double length = norm(p);
  if (length > 0) return {p / length, length - radius};
  return {squared_norm(wish) > 0 ? normalized(wish) : unit_axis(2), -radius};
}

NearestSurface nearest_surface_of_box(const Vec3& half, const std::same_as<Vec3> auto& p) {
  Vec3 beyond;
  for (int k = 0; k < 3; ++k) beyond[k] = p[k] - std::clamp(p[k], -half[k], half[k]);
  const double length = norm(beyond);
  if (length > 0) return {beyond / length, length};
  int nearest = 0;
  double inside = std::numeric_limits<double>::infinity();
  for (int k = 0; k < 3; ++k) {
    const double depth = half[k] - std::abs(p[k]);
    if (depth < inside) inside = depth, nearest = k;
  }
  return {with_sign(1, p[nearest]) * unit_axis(nearest), -inside};
}

NearestSurface nearest_surface_of_capsule(double radius, double half, const std::same_as<Vec3> auto& p,
                                          const Vec3& wish) {
  const Vec3 from_axis = p - Vec3(0, 0, std::clamp(p[2], -half, half));
  const double length = norm(from_axis);
  if (length > 0) return {from_axis / length, length - radius};
  return {perpendicular(unit_axis(2), wish), -radius};
}

NearestSurface nearest_surface_of_cylinder(double radius, double half, const std::same_as<Vec3> auto& p,
                                           const Vec3& wish) {
  const double rho = std::hypot(p[0], p[1]), side = rho - radius, cap = std::abs(p[2]) - half;
  const Vec3 outward = rho > 0 ? Vec3(p[0] / rho, p[1] / rho, 0) : perpendicular(unit_axis(2), wish);
  const Vec3 along = with_sign(1, p[2]) * unit_axis(2);
  if (side > 0 && cap > 0) {
    const double length = std::hypot(side, cap);
    return {(side * outward + cap * along) / length, length};
  }
  return side > cap ? NearestSurface{outward, side} : NearestSurface{along, cap};
}

/// In the half-plane of the axis and p, with ρ the distance from the axis and z the height above the base: a right
/// triangle with the corners (0, 0), the rim (r, 0) and the tip (0, height).
NearestSurface nearest_surface_of_cone(double radius, double height, const std::same_as<Vec3> auto& p, const Vec3& wish) {
  const double rho = std::hypot(p[0], p[1]), z = p[2] + 0.25 * height, slant = std::hypot(radius, height);
  const Vec3 outward = rho > 0 ? Vec3(p[0] / rho, p[1] / rho, 0) : perpendicular(unit_axis(2), wish);
  const Vec3 up = unit_axis(2), mantle = (height * outward + radius * up) / slant;
  const double above_mantle = (height * (rho - radius) + radius * z) / slant;
  const double up_mantle = (height * z - radius * (rho - radius)) / slant;
  if (above_mantle <= 0 && z >= 0)
    return above_mantle > -z ? NearestSurface{mantle, above_mantle} : NearestSurface{-up, -z};
  if (z < 0 && rho <= radius) return {-up, -z};
  if (up_mantle > 0 && up_mantle < slant) return {mantle, above_mantle};
  const Vec3 from_corner = up_mantle > 0 ? Vec3(rho * outward + (z - height) * up)
                                         : Vec3((rho - radius) * outward + z * up);
  const double length = norm(from_corner);
  return length > 0 ? NearestSurface{from_corner / length, length} : NearestSurface{mantle, 0};
}

NearestSurface nearest_surface(const std::same_as<Shape> auto& s, const Vec3& p, const Vec3& wish) {
  switch (s.outline()) {
    case ShapeKind::box:
      return nearest_surface_of_box({s.size[0], s.size[1], s.size[2]}, p);
    case ShapeKind::capsule:
      return nearest_surface_of_capsule(s.size[0], s.size[1], p, wish);
    case ShapeKind::cylinder:
      return nearest_surface_of_cylinder(s.size[0], s.size[1], p, wish);
    case ShapeKind::cone:
      return nearest_surface_of_cone(s.size[0], 2 * s.size[1], p, wish);
    case ShapeKind::ellipsoid:
      return nearest_surface_of_ellipsoid({s.size[0], s.size[1], s.size[2]}, p, wish);
    default:
      return nearest_surface_of_ball(s.size[0], p, wish);
  }
}

}  // namespace delassus::inner
