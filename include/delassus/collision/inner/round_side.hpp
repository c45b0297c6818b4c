/// Where a line along a contact normal meets the side of a capsule, a cylinder or a cone.
#pragma once

#include <delassus/collision/patch.hpp>
#include <delassus/core/cmath.hpp>
#include <delassus/geometry/shape.hpp>
#include <delassus/math/pose.hpp>

namespace delassus::inner {

inline bool has_round_side(const Shape& s) {
  return s.kind == ShapeKind::capsule || s.kind == ShapeKind::cylinder || s.kind == ShapeKind::cone;
}

/// The larger root τ of a τ² + 2 b τ + c = 0 for b > 0 and small c, without cancellation; false where there is none.
inline bool leaves(double a, double b, double c, double& way) {
  const double discriminant = b * b - a * c;
  if (!(b > 0 && discriminant >= 0)) return false;
  way = -c / (b + std::sqrt(discriminant));
  return true;
}

/// The way τ (m) from x, next to the side, to where the line x + τ d leaves the solid; d is a unit vector. All in the
/// body's frame. False where the line passes the solid.
///
/// The side is |(x, y)| = r, of a cone |(x, y)| = k (tip − z). Beyond its ends come the ball of a capsule and the flat base.
inline bool leave_side(const Shape& s, const Vec3& x, const Vec3& d, double& way) {
  const bool is_cone = s.kind == ShapeKind::cone;
  const double half = s.size[1], slope = is_cone ? s.size[0] / (2 * half) : 0,
               radius = is_cone ? slope * (1.5 * half - x[2]) : s.size[0];
  if (is_cone && radius <= 1e-12 * half) {  // the tip
    way = 0;
    return true;
  }
  const double b = x[0] * d[0] + x[1] * d[1] + slope * radius * d[2];
  const double outside = std::hypot(x[0], x[1]) - radius;
  if (!leaves(d[0] * d[0] + d[1] * d[1] - slope * slope * d[2] * d[2], b, outside * (outside + 2 * radius), way)) return false;
  const double low = is_cone ? -0.5 * half : -half, high = is_cone ? 1.5 * half : half, z = x[2] + way * d[2];
  if (z >= low && z <= high) return true;
  const double end = z < low ? low : high;
  if (s.kind == ShapeKind::capsule) {
    const Vec3 from(x[0], x[1], x[2] - end);
    return leaves(1, dot(from, d), squared_norm(from) - s.size[0] * s.size[0], way);
  }
  if (std::abs(z - end) <= 1e-12 * half) return true;  // x is at the end, but for rounding
  if (is_cone && z > high) return false;               // past the tip
  if ((z < low) == (d[2] > 0)) return false;           // it left the side before it came to the base
  way = (end - x[2]) / d[2];
  return std::abs(way) <= s.size[0];
}

/// Moves the points of a patch on this body to its round side, along the normal n from A to B; those that no such line
/// meets go, and those that would then be deeper than `least`, a gap: no point is deeper than the bodies. A point of a patch is made of
/// straight lines: where these cross, or a capsule leans, it lies inside.
inline void lay_on_side(const Shape& s, const Pose& pose, const Vec3& n, bool is_a, double least, Patch& patch) {
  const Vec3 out = is_a ? n : Vec3(-n), d = transposed_times(pose.rotation, out);
  int kept = 0;
  for (int i = 0; i < patch.count; ++i) {
    PatchPoint p = patch.point[i];
    Vec3& own = is_a ? p.a : p.b;
    double way = 0;
    if (!leave_side(s, pose.to_local(own), d, way) || p.gap - way < least) continue;
    own += way * out;
    p.gap -= way;
    patch.point[kept++] = p;
  }
  patch.count = kept;
}

}  // namespace delassus::inner
