/// Boxes and margins that grow with size and speed.
#pragma once

#include <delassus/collision/collider.hpp>
#include <delassus/collision/inner/summary.hpp>
#include <delassus/collision/plane.hpp>
#include <delassus/collision/settings.hpp>
#include <delassus/core/cmath.hpp>
#include <delassus/geometry/support.hpp>

#include <algorithm>

namespace delassus {

namespace inner {

inline constexpr double margin_share = 5e-3, margin_limit = 0.5;
/// Two bodies touch when they are nearer than this share of their size.
inline constexpr double touch_share = 1e-4;

inline double limited_margin(double way, double scale) {
  return std::min(std::max(margin_share * scale, way), margin_limit * scale);
}

/// A margin that no contact of a pair exceeds that closes in at up to `speed`, m/s, whatever its normal.
inline double widest_margin(double speed, double scale, double h, const CollisionSettings& s) {
  return s.margin >= 0 ? s.margin : limited_margin(speed * h, scale);
}

/// The margin of a contact at `point` with the world normal n; vₙ is the relative normal velocity there.
inline double margin_along(const Collider& a, const Collider& b, const Vec3& n, const Vec3& point,
                           double scale, double h, const CollisionSettings& s) {
  if (s.margin >= 0) return s.margin;
  return limited_margin(std::abs(dot(n, b.velocity_at(point) - a.velocity_at(point))) * h, scale);
}

/// The tight box, wider by the collider's share of any margin: a pair within its margin has boxes that touch.
/// A half-space and a body that is not finite have none. (min(x, L_a/2) + min(y, L_b/2) ≥ min(x + y, min(L_a,
/// L_b)/2), and L_a + L_b ≥ 2 min(L_a, L_b).)
inline Aabb alarm_box(const Collider& c, const Summary& of, double h, const CollisionSettings& s) {
  if (c.shape.kind == ShapeKind::half_space) return Aabb();
  Aabb box = tight_box(c.shape, c.pose);
  const Vec3 sizes = box.max() - box.min();
  if (box.is_empty() || !is_finite(sizes) || !is_finite(c.pose.rotation) || !std::isfinite(of.speed))
    return Aabb();
  const double share = s.margin >= 0 ? 0.5 * s.margin
                                     : std::min(std::max(0.5 * margin_share * of.scale, of.speed * h),
                                                margin_limit * of.scale);
  const double more = 0.5 * s.contact_distance + share + 1e-12 * max_entry(sizes);
  for (int k = 0; k < 3; ++k) box.min()[k] -= more, box.max()[k] += more;
  return box;
}

/// Which boxes a half-space may touch.
struct PlaneReach {
  Plane plane;
  Vec3 pivot;                ///< where the half-space turns about, m
  double way, turn, margin, contact_distance;  ///< way (m) and turn (rad) of a step

  PlaneReach(const Collider& half_space, double h, const CollisionSettings& s)
      : plane(plane_of(half_space.shape, half_space.pose)), pivot(half_space.pose.position), way(norm(half_space.velocity) * h),
        turn(norm(half_space.angular_velocity) * h), margin(s.margin), contact_distance(s.contact_distance) {}

  /// False when the box, with all the margin its pair with this half-space can have, lies clear of the solid.
  bool may_touch(const Aabb& box) const {
    const Vec3 sizes = box.max() - box.min(), centre = (box.min() + box.max()) / 2;
    double reach = 0;
    for (int k = 0; k < 3; ++k) reach += std::abs(plane.normal[k]) * sizes[k];
    const double lowest = dot(plane.normal, centre) - 0.5 * reach;
    double share = std::max(way, 0.5 * (margin >= 0 ? margin : max_entry(sizes)));
    if (turn > 0) share = std::max(share, way + turn * (norm(Vec3(centre - pivot)) + 0.5 * norm(sizes)));
    return lowest - plane.offset <= contact_distance + share;
  }
};

}  // namespace inner
}  // namespace delassus
