/// Pairs that touch in one point: balls and capsules, and a ball over a half-space.
#pragma once

#include <delassus/collision/certificate.hpp>
#include <delassus/collision/closed_forms.hpp>
#include <delassus/collision/collider.hpp>
#include <delassus/collision/half_space.hpp>
#include <delassus/collision/pair_memory.hpp>
#include <delassus/core/cmath.hpp>
#include <delassus/geometry/face.hpp>

#include <algorithm>
#include <limits>

namespace delassus::inner {

[[gnu::always_inline]] inline bool is_ball_or_capsule(const Shape& s) {
  return s.kind == ShapeKind::sphere || s.kind == ShapeKind::capsule;
}
[[gnu::always_inline]] inline bool is_round_pair(const Shape& a, const Shape& b) {
  if (b.kind == ShapeKind::half_space) return a.kind == ShapeKind::sphere;
  return is_ball_or_capsule(b) &&
         (is_ball_or_capsule(a) || (a.kind == ShapeKind::half_space && b.kind == ShapeKind::sphere));
}

/// Of the ball about a ball or a capsule, m.
[[gnu::always_inline]] inline double radius_about(const Shape& s) {
  return s.kind == ShapeKind::sphere ? s.size[0] : s.size[0] + s.size[1];
}
/// Pre: `is_round_pair`. Whether the balls about two bodies are clearly farther apart than `reach`, m; then
/// this is taken down. Two numbers tell of most pairs that a pile's boxes offer.
inline bool are_balls_far(const Collider& a, const Collider& b, double reach, PairMemory& now) {
  if (a.shape.kind == ShapeKind::half_space || b.shape.kind == ShapeKind::half_space) return false;
  const Vec3 way = b.pose.position - a.pose.position;
  const double square = squared_norm(way), limit = reach + radius_about(a.shape) + radius_about(b.shape);
  if (!(square > (1 + 1e-4) * limit * limit && square < std::numeric_limits<double>::infinity()))
    return false;  // a rotation may have been one of single precision
  now.normal = way / std::sqrt(square);
  now.count = 0;
  return true;
}

/// The formula of two balls with its certificate, bit by bit what `certified_pair` says of them; false where
/// that is to be asked: one centre is in the other, or the numbers do not hold.
inline bool two_balls(double radius_a, double radius_b, const Pose& b_in_a, double margin, double scale,
                      SignedPair& r) {
  const Vec3& centre = b_in_a.position;
  if (!(squared_norm(centre) > 0)) return false;
  const NearestSurface s = nearest_surface_of_ball(radius_a, centre, centre);
  r.distance = s.distance - radius_b;
  r.normal = s.normal;
  r.status = r.distance > margin ? PairStatus::far : PairStatus::near;
  if (!is_finite(r.normal) || !std::isfinite(r.distance)) return false;
  const double excess = squared_norm(r.normal) - 1;
  if (!(std::abs(excess) < 1e-9)) return false;
  r.point_a = centre - s.distance * s.normal;
  r.point_b = centre - radius_b * s.normal;
  if (std::abs(excess) > 1e-15) r.normal *= 1 - 0.5 * excess;
  const Vec3 &n = r.normal, none = zero<Vec3>(), down = -transposed_times(b_in_a.rotation, n);
  const double height_a = dot(n, Vec3(none + radius_a * n)),
               height_b = dot(n, b_in_a.to_world(Vec3(none + radius_b * down)));
  const double proven = height_b - height_a;
  if (r.status == PairStatus::far) return proven > (1 - 1e-3) * margin;
  if (!(std::abs(proven - r.distance) <= 1e-3 * std::max(std::abs(r.distance), 1e-3 * scale))) return false;
  if (!is_finite(r.point_a) || !is_finite(r.point_b)) return false;
  r.distance = proven;
  put_witnesses(height_a, height_b, r);
  return true;
}

/// Pre: one is a capsule, the other one or a ball. The formula with its certificate; false where axes meet,
/// or run beside each other so that they touch in more than a point.
[[gnu::always_inline]] inline bool with_capsule(const Shape& a, const Shape& b, const Pose& b_in_a,
                                                double margin, double scale, SignedPair& r) {
  closed_form(a, b, b_in_a, zero<Vec3>(), r);
  if (!(r.distance + a.size[0] + b.size[0] > 1e-9 * scale &&
        r.distance < std::numeric_limits<double>::infinity()))
    return false;
  if (r.distance > margin) {
    r.status = PairStatus::far;
    return true;
  }
  const Vec3 v = column(b_in_a.rotation, 2), &n = r.normal;
  const bool are_long = a.kind == b.kind,
             are_parallel = std::abs(v[0] * n[1] - v[1] * n[0]) <= 1.001 * line_slope;
  return !(are_long && are_parallel) && certify(a, b, b_in_a, margin, scale, r);
}

/// What `half_space_patch` says of a ball; false where a number does not hold.
inline bool ball_over_plane(const Shape& a, const Shape& b, const Pose& b_in_a, double margin,
                            SignedPair& r) {
  const PlanePair pair(a, b, b_in_a);
  const PatchPoint lowest = pair.contact(pair.lowest(), Patch::witness);
  r = pair.answer(lowest, margin);
  return std::isfinite(r.distance);
}

/// Pre: `is_round_pair`. The one answer that such a pair needs, up to `margin`, in the frame of A; false
/// where it is to be asked in full.
inline bool one_point(const Shape& a, const Shape& b, const Pose& b_in_a, double margin, double scale,
                      SignedPair& r) {
  if (a.kind == ShapeKind::half_space || b.kind == ShapeKind::half_space)
    return ball_over_plane(a, b, b_in_a, margin, r);
  if (a.kind == ShapeKind::capsule || b.kind == ShapeKind::capsule)
    return with_capsule(a, b, b_in_a, margin, scale, r);
  return two_balls(a.size[0], b.size[0], b_in_a, margin, scale, r);
}

}  // namespace delassus::inner
