/// How far a shape reaches in a direction: support points, tight boxes, sizes.
#pragma once

#include <delassus/core/cmath.hpp>
#include <delassus/core/slice.hpp>
#include <delassus/geometry/aabb.hpp>
#include <delassus/geometry/convex_hull.hpp>
#include <delassus/geometry/shape.hpp>
#include <delassus/math/pose.hpp>
#include <delassus/math/two_lanes.hpp>

#include <algorithm>
#include <concepts>
#include <limits>

namespace delassus {

/// A convex body, as distances and penetrations see it: a core, and all points within a radius of the core.
template <class S>
concept ConvexSupport = requires(const S& s, const Vec3& direction) {
  {
    core_support(s, direction)
    } -> std::same_as<Vec3>;                          // argmax of direction · x over the core, body frame, m
  { core_radius(s) } -> std::convertible_to<double>;  // what the core is thickened by, m
};

namespace inner {

inline double with_sign(double size, double of) { return of < 0 ? -size : size; }

inline Vec3 cylinder_support(double radius, double half, const Vec3& d) {
  const double across = std::hypot(d[0], d[1]), z = with_sign(half, d[2]);
  if (!(across > 0)) return {0, 0, z};
  return {d[0] / across * radius, d[1] / across * radius, z};
}

/// The tip, or the point of the base's rim; `half` is half the height.
inline Vec3 cone_support(double radius, double half, const Vec3& d) {
  const double across = std::hypot(d[0], d[1]);
  if (2 * half * d[2] >= radius * across && d[2] > 0) return {0, 0, 1.5 * half};
  if (!(across > 0)) return {0, 0, -0.5 * half};
  return {d[0] / across * radius, d[1] / across * radius, -0.5 * half};
}

/// D² d / |D d| with the semi-axes D: where the tangent plane is normal to d.
inline Vec3 ellipsoid_support(const Vec3& axes, const Vec3& d) {
  Vec3 stretched(axes[0] * d[0], axes[1] * d[1], axes[2] * d[2]);
  const double length = norm(stretched);
  if (!(length > 0)) return {0, 0, axes[2]};
  for (int k = 0; k < 3; ++k) stretched[k] *= axes[k] / length;
  return stretched;
}

inline Index support_vertex(const ConvexHull& h, const Vec3& d) {
  const Slice<const Vec3> vertices = h.vertices();
  Index best = 0;
  double reach = dot(vertices[0], d);
  for (Index i = 1; i < Index(vertices.size()); ++i) {
    const double r = dot(vertices[i], d);
    if (r > reach) reach = r, best = i;
  }
  return best;
}

}  // namespace inner

/// Spheres and capsules have a point and a segment as their cores; every other shape is its own core.
inline Vec3 core_support(const Shape& s, const Vec3& d) {
  switch (s.kind) {
    case ShapeKind::capsule:
      return {0, 0, inner::with_sign(s.size[1], d[2])};
    case ShapeKind::box:
    case ShapeKind::mesh:
    case ShapeKind::compound:
      return {inner::with_sign(s.size[0], d[0]), inner::with_sign(s.size[1], d[1]),
              inner::with_sign(s.size[2], d[2])};
    case ShapeKind::cylinder:
      return inner::cylinder_support(s.size[0], s.size[1], d);
    case ShapeKind::cone:
      return inner::cone_support(s.size[0], s.size[1], d);
    case ShapeKind::ellipsoid:
      return inner::ellipsoid_support({s.size[0], s.size[1], s.size[2]}, d);
    case ShapeKind::convex_hull:
      return s.hull->vertices()[inner::support_vertex(*s.hull, d)];
    default:
      return zero<Vec3>();
  }
}

inline double core_radius(const Shape& s) {
  return s.kind == ShapeKind::sphere || s.kind == ShapeKind::capsule ? s.size[0] : 0.0;
}
/// The point of the body farthest along the unit vector `n`, body frame. Not for half-spaces, which have
/// none.
template <ConvexSupport S>
Vec3 support(const S& s, const Vec3& n) {
  return core_support(s, n) + core_radius(s) * n;
}

/// The farthest any point of the shape is from the origin of its frame, m; 0 for a half-space.
inline double outer_radius(const Shape& s) {
  switch (s.outline()) {
    case ShapeKind::sphere:
      return s.size[0];
    case ShapeKind::box:
      return std::sqrt(s.size[0] * s.size[0] + s.size[1] * s.size[1] + s.size[2] * s.size[2]);
    case ShapeKind::capsule:
      return s.size[0] + s.size[1];
    case ShapeKind::cylinder:
      return std::hypot(s.size[0], s.size[1]);
    case ShapeKind::cone:
      return std::max(1.5 * s.size[1], std::hypot(s.size[0], 0.5 * s.size[1]));
    case ShapeKind::ellipsoid:
      return std::max(std::max(s.size[0], s.size[1]), s.size[2]);
    case ShapeKind::convex_hull:
      return norm(s.hull->centroid()) + s.hull->outer_radius();
    default:
      return 0;
  }
}

/// The size L of a shape, m, to which tolerances and margins are relative: its largest half extent.
inline double length_scale(const Shape& s) {
  switch (s.outline()) {
    case ShapeKind::box:
      return std::max(std::max(s.size[0], s.size[1]), s.size[2]);
    case ShapeKind::cylinder:
    case ShapeKind::cone:
      return std::max(s.size[0], s.size[1]);
    case ShapeKind::convex_hull:
      return s.hull->outer_radius();
    default:
      return outer_radius(s);
  }
}

/// A point well inside the shape, body frame.
inline Vec3 middle(const Shape& s) {
  return s.kind == ShapeKind::convex_hull ? s.hull->centroid() : zero<Vec3>();
}

namespace inner {

/// How far a disc of radius 1 about the axis z reaches along the k-th axis of the world: no entry of a
/// rotation is large enough to need std::hypot.
inline double across(const Mat3& R, int k) { return std::sqrt(R(k, 0) * R(k, 0) + R(k, 1) * R(k, 1)); }

/// How far a shape that is symmetric about its origin reaches along each axis of the world, m.
Vec3 half_widths(const std::same_as<Shape> auto& s, const Mat3& R) {
  Vec3 reach;
  for (int k = 0; k < 3; ++k) switch (s.outline()) {
      case ShapeKind::sphere:
        reach[k] = s.size[0];
        break;
      case ShapeKind::box:
        reach[k] = std::abs(R(k, 0)) * s.size[0] + std::abs(R(k, 1)) * s.size[1] + std::abs(R(k, 2)) * s.size[2];
        break;
      case ShapeKind::capsule:
        reach[k] = std::abs(R(k, 2)) * s.size[1] + s.size[0];
        break;
      case ShapeKind::cylinder:
        reach[k] = std::abs(R(k, 2)) * s.size[1] + across(R, k) * s.size[0];
        break;
      case ShapeKind::ellipsoid:
        reach[k] = norm(Vec3(R(k, 0) * s.size[0], R(k, 1) * s.size[1], R(k, 2) * s.size[2]));
        break;
      default:
        reach[k] = std::numeric_limits<double>::infinity();
    }
  return reach;
}

/// Of the tip and the disc of the base.
template <class Box>
Box cone_box(const Shape& s, const Pose& pose) {
  Vec3 low, high;
  for (int k = 0; k < 3; ++k) {
    const double axis = pose.rotation(k, 2) * s.size[1], tip = 1.5 * axis, base = -0.5 * axis;
    const double rim = across(pose.rotation, k) * s.size[0];
    low[k] = pose.position[k] + std::min(tip, base - rim);
    high[k] = pose.position[k] + std::max(tip, base + rim);
  }
  return Box(low, high);
}

/// As many vertices at a time as there are lanes, each lane with its own extremes.
template <class Box>
Box hull_box(const ConvexHull& hull, const Pose& pose) {
  const Mat3& R = pose.rotation;
  constexpr double infinity = std::numeric_limits<double>::infinity();
  TwoLanes least[3], most[3];
  for (int k = 0; k < 3; ++k) least[k] = TwoLanes{infinity, infinity}, most[k] = -least[k];
  const Slice<const double> blocks = hull.blocks();
  for (std::size_t i = 0; i < blocks.size(); i += 6) {
    const TwoLanes x = two_lanes_at(&blocks[i]), y = two_lanes_at(&blocks[i + 2]),
                   z = two_lanes_at(&blocks[i + 4]);
    for (int k = 0; k < 3; ++k) {
      const TwoLanes along = R(k, 0) * x + R(k, 1) * y + R(k, 2) * z;
      least[k] = along < least[k] ? along : least[k];
      most[k] = along > most[k] ? along : most[k];
    }
  }
  Vec3 low = pose.position, high = pose.position;
  for (int k = 0; k < 3; ++k) {
    low[k] += std::min(least[k][0], least[k][1]);
    high[k] += std::max(most[k][0], most[k][1]);
  }
  return Box(low, high);
}

}  // namespace inner

/// The smallest box with axes of the world around a posed shape, m. Infinite for a half-space, empty for no
/// shape.
template <class Box = Aabb>
Box tight_box(const Shape& s, const Pose& pose) {
  if (s.kind == ShapeKind::none) return Box();
  if (s.kind == ShapeKind::convex_hull) return inner::hull_box<Box>(*s.hull, pose);
  if (s.kind == ShapeKind::cone) return inner::cone_box<Box>(s, pose);
  const Vec3 reach = inner::half_widths(s, pose.rotation);
  return Box(pose.position - reach, pose.position + reach);
}

}  // namespace delassus
