/// Bodies that are apart: whether they meet within the step, and the rows of the place where they will.
#pragma once

#include <delassus/collision/collider.hpp>
#include <delassus/collision/inner/margins.hpp>
#include <delassus/collision/inner/name_points.hpp>
#include <delassus/collision/inner/stay_apart.hpp>
#include <delassus/collision/inner/summary.hpp>
#include <delassus/collision/inner/time_of_impact.hpp>
#include <delassus/collision/pair_memory.hpp>

#include <algorithm>
#include <cstdint>
#include <vector>

namespace delassus::inner {

/// Two bodies meet when they come nearer than that.
inline constexpr double meeting_share = 1e-4;
/// Cosine of the angle, 4.5e-5, within which two normals count as one.
inline constexpr double same_normal = 1 - 1e-9;

/// A pair that is apart: its distance now, or less, and the normal there. World frame, m.
struct Apart {
  PairJob job;
  double distance;
  Vec3 normal;
  bool is_foreseen = false;  ///< it has contacts, of the place where it was to meet
};

/// False where the plane between the two, or one that is nearer to both, proves that they stay apart in the step.
inline bool may_close(const Collider& a, const Collider& b, const Vec3& normal, double distance, double h) {
  return h * (dot(normal, a.velocity - b.velocity) + turning_speeds(a, b, h)) >= distance;
}

/// False where the balls about the two, each going its way, prove that they do not come within `target` (m) in the step. By a
/// margin so large that `time_of_impact` does not end for its number of looks either.
inline bool may_come_near(const Collider& a, const Collider& b, double h, double target) {
  const Vec3 apart = b.pose.position - a.pose.position, going = b.velocity - a.velocity;
  const bool a_is_plane = a.shape.kind == ShapeKind::half_space;
  const double speed = norm(going) + turning_speeds(a, b, h), radii = outer_radius(a.shape) + outer_radius(b.shape),
               slack = speed * h / 150 + 1e-9 * radii + 1e-12 * (norm(a.pose.position) + norm(b.pose.position));
  if (a_is_plane || b.shape.kind == ShapeKind::half_space) {
    const Collider &c = a_is_plane ? a : b, &body = a_is_plane ? b : a;
    if (!is_zero(c.angular_velocity)) return true;
    const Plane plane = plane_of(c.shape, c.pose);
    const double above = dot(plane.normal, body.pose.position) - plane.offset, way = h * dot(plane.normal, Vec3(body.velocity - c.velocity));
    return !(above + std::min(way, 0.0) - radii > target + slack + 1e-12 * std::abs(plane.offset));
  }
  const double square = squared_norm(going), time = square > 0 ? std::clamp(-dot(apart, going) / square, 0.0, h) : 0.0;
  return !(norm(Vec3(apart + time * going)) - radii > target + slack);
}

/// Whether the two may close in by more than the widest margin: then some points of a face may be within it and others not.
inline bool may_outgrow_margin(const Collider& a, const Collider& b, double scale, double h) {
  if (a.shape.kind == ShapeKind::sphere || b.shape.kind == ShapeKind::sphere) return false;  // one point
  return h * (norm(Vec3(a.velocity - b.velocity)) + turning_speeds(a, b, h)) > margin_limit * scale;
}

/// Whether a body turns so much in a step, by 1e-3, that its points are elsewhere than an impact of the last one foresaw.
inline bool has_turned(const Collider& c, double h) { return c.shape.kind != ShapeKind::sphere && h * norm(c.angular_velocity) > 1e-3; }

/// How far any of its points may go in the step, m, and at least half the least margin.
inline double longest_way(const Summary& of, double h, const CollisionSettings& s) {
  return std::max(0.5 * (s.margin >= 0 ? s.margin : margin_share * of.scale), of.speed * h);
}

/// The box of the margins and of the whole way: pairs without a contact are found too.
inline Aabb box_of_way(const Collider& c, const Summary& of, double h, const CollisionSettings& s) {
  Aabb box = alarm_box(c, of, h, s);
  if (box.is_empty() || !(of.speed * h > (s.margin >= 0 ? 0.5 * s.margin : margin_limit * of.scale))) return box;
  Aabb now = tight_box(c.shape, c.pose);
  if (!is_zero(c.angular_velocity)) {
    const double r = outer_radius(c.shape);
    now = Aabb(Vec3(c.pose.position - Vec3(r, r, r)), Vec3(c.pose.position + Vec3(r, r, r)));
  }
  return box.extend(now).extend(Aabb(Vec3(now.min() + h * c.velocity), Vec3(now.max() + h * c.velocity)));
}

/// A row that lets the points at these arms, one of each body, close in by the gap within a step.
inline ContactPoint row_ahead(const PairJob& job, const Collider& a, const Collider& b, const Vec3& arm_a, const Vec3& arm_b, const Vec3& n,
                              double gap, std::uint32_t name) {
  const Vec3 on_a = a.pose.position + arm_a, on_b = b.pose.position + arm_b, middle = 0.5 * (on_a + on_b);
  return {.a = job.a, .b = job.b, .point_a = middle - 0.5 * gap * n, .point_b = middle + 0.5 * gap * n, .normal = n, .gap = gap, .pair = job.pair, .feature = name,
          .travel = on_b - on_a};
}

/// The row of a point p of the patch, in the frame of A, that the two have where they meet with the world normal n.
inline ContactPoint impact_row(const PairJob& job, const Collider& a, const Collider& b, const Impact& hit, const PatchPoint& p,
                               const Vec3& n, double contact_distance, std::uint32_t name) {
  const Vec3 arm_a = hit.a.to_world(p.a) - hit.a.position, arm_b = hit.a.to_world(p.b) - hit.b.position;
  const double closing = dot(n, a.velocity + cross(a.angular_velocity, arm_a) - b.velocity - cross(b.angular_velocity, arm_b));
  const double gap = std::max(hit.time * closing, 0.0) + std::max(p.gap - contact_distance, 0.0);
  return row_ahead(job, a, b, arm_a, arm_b, n, gap, name);
}

/// Whether the two still come nearer where they met: who has bounced has nothing left of the approach.
inline bool goes_on(const RememberedImpact& impact, const Collider& a, const Collider& b) {
  return dot(impact.normal, a.velocity + cross(a.angular_velocity, impact.arm_a) - b.velocity - cross(b.angular_velocity, impact.arm_b)) > 0;
}

/// Whether the contacts from `first` on are about the point of one of the bodies where they met.
inline bool is_there(const RememberedImpact& impact, const Collider& a, const Collider& b, std::size_t first, const std::vector<ContactPoint>& out,
                     double scale) {
  Vec3 middle = zero<Vec3>();
  for (std::size_t i = first; i < out.size(); ++i) middle += (out[i].area > 0 ? out[i].middle : out[i].point()) / double(out.size() - first);
  const auto beside = [&](const Vec3& x) { return norm(x - middle - dot(impact.normal, Vec3(x - middle)) * impact.normal); };
  return std::min(beside(a.pose.position + impact.arm_a), beside(b.pose.position + impact.arm_b)) <= 1e-2 * scale;
}

/// Whether a body may go farther in a step than the ball of half its thickness: an impulse beside its middle would turn it and
/// let it fly on. `speed` is its `top_speed`, m/s.
inline bool flies_by(const Collider& c, double speed, double h) {
  return c.is_movable && c.shape.has_volume() && h * speed > core_of_motion(c.shape);
}
inline bool flies_by(const Collider& c, double h) { return flies_by(c, top_speed(c), h); }

/// The row of a middle, of A or else of B, whose core has this radius; names are above all others. It does not turn the body that it holds.
inline ContactPoint core_row(const PairJob& job, const Collider& a, const Collider& b, bool is_a, const Impact& hit, double radius, const Vec3& n,
                             std::uint32_t which) {
  const Vec3 touch = is_a ? Vec3(hit.a.position + radius * n) : Vec3(hit.b.position - radius * n);
  const Vec3 arm_a = is_a ? zero<Vec3>() : Vec3(touch - hit.a.position), arm_b = is_a ? Vec3(touch - hit.b.position) : zero<Vec3>();
  const double closing = dot(n, a.velocity + cross(a.angular_velocity, arm_a) - b.velocity - cross(b.angular_velocity, arm_b));
  return row_ahead(job, a, b, arm_a, arm_b, n, std::max(hit.time * closing, 0.0), 0xfffffff1u + which);
}

/// Holds the middle of such a body by a row, and says whether it was needed. The ball goes without turning.
inline bool hold_core(const PairJob& job, const Collider& a, const Collider& b, bool is_a, double h, std::vector<ContactPoint>& out) {
  const Collider& body = is_a ? a : b;
  const double radius = core_of_motion(body.shape);
  Collider core = body;
  core.shape = Sphere{radius};
  set_zero(core.angular_velocity);
  const Collider &x = is_a ? core : a, &y = is_a ? b : core;
  const Impact hit = time_of_impact(x, y, h, radius, 1e-3 * radius);
  if (!hit.is_found && !hit.is_now) return false;
  const Vec3 n = hit.a.rotation * hit.normal_in_a;
  const double flight = dot(n, a.velocity - b.velocity);
  if (!(flight > 0) && !hit.is_now) return false;
  out.push_back(core_row(job, x, y, is_a, hit, radius, n, is_a ? 0 : 1));
  return true;
}

}  // namespace delassus::inner
