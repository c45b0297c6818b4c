/// When two moving shapes first touch within a step.
#pragma once

#include <delassus/collision/certified_pair.hpp>
#include <delassus/collision/collider.hpp>
#include <delassus/collision/inner/margins.hpp>
#include <delassus/collision/inner/one_point.hpp>
#include <delassus/collision/inner/summary.hpp>
#include <delassus/math/rotation.hpp>

#include <algorithm>
#include <limits>

namespace delassus::inner {

/// Where a collider is after t s with its present velocities.
inline Pose pose_after(const Collider& c, double t) {
  if (is_zero(c.angular_velocity)) return {c.pose.position + t * c.velocity, c.pose.rotation};
  const Quat turn = exponential<double>(Vec3(t * c.angular_velocity));
  return {c.pose.position + t * c.velocity, turn.toRotationMatrix() * c.pose.rotation};
}

/// Signed distance and, of a half-space, its patch up to `margin` beyond it, in the frame of A.
inline SignedPair distance_of(const Shape& a, const Shape& b, const Pose& b_in_a, double margin, double scale,
                              const Vec3& guess, Patch& patch) {
  if (a.kind == ShapeKind::half_space || b.kind == ShapeKind::half_space)
    return half_space_patch(a, b, b_in_a, margin, scale, patch);
  GjkEpa kernel;
  return certified_pair(kernel, a, b, b_in_a, margin, scale, guess).pair;
}

/// Half the radius of a ball about the middle that the shape holds, m.
inline double core_of_motion(const Shape& s) {
  switch (s.kind) {
    case ShapeKind::box:
    case ShapeKind::ellipsoid:
      return 0.5 * std::min(std::min(s.size[0], s.size[1]), s.size[2]);
    case ShapeKind::cylinder:
      return 0.5 * std::min(s.size[0], s.size[1]);
    case ShapeKind::cone:
      return s.size[0] * s.size[1] / (s.size[0] + std::hypot(s.size[0], 2 * s.size[1]));
    case ShapeKind::convex_hull:
      return 0.5 * s.hull->inner_radius();
    default:
      return 0.5 * s.size[0];
  }
}

struct Impact {
  bool is_found = false;
  bool is_now = false;  ///< within the target from the start: not found, but `normal_in_a` holds
  double time = 0;      ///< s from now
  Pose a, b;            ///< where both are then
  Vec3 normal_in_a = zero<Vec3>();
};

/// How far below the chord of its ends the distance of two bodies may dip within `time` of the h s of a step, m, along a normal that
/// goes from n to m on a line. That of two points is n · (y − x); its second derivative is
///
///   2 ṅ · (v_B − v_A) + n · (a_B − a_A),   |ṅ| = |m − n| / time,   |a| ≤ |ω|² r,
///
/// and the least of many such lies above the chord of its ends as each does.
[[gnu::always_inline]] inline double dip(const Collider& a, const Collider& b, const Vec3& n, const Vec3& m, double time, double h) {
  const double turning_a = turning_speed(a, b, h), turning_b = turning_speed(b, a, h);
  return time * (norm(Vec3(m - n)) * (norm(Vec3(a.velocity - b.velocity)) + turning_a + turning_b) / 4 +
                 time * (norm(a.angular_velocity) * turning_a + norm(b.angular_velocity) * turning_b) / 8);
}

/// Conservative advancement [Mirtich1996]: no point closes in along n faster than
///
///   μ = n · (v_A − v_B) + |ω_A| r_A + |ω_B| r_B,
///
/// so that d / μ may pass at a time. Ends within `target` m of touching, or when the step is over; when 200
/// looks do not decide, the last place counts as one of impact. That is slow where bodies turn beside each other: then a look far
/// ahead may tell, by `dip`, that all between is apart. Nothing is found for shapes that are within
/// `target` now. distance(b_in_a, guess): the signed distance of the two. The first
/// guess is a normal in the frame of A, or zero.
template <class Distance>
Impact time_of_impact(const Collider& a, const Collider& b, double h, double target, Vec3 guess, const Distance& distance) {
  Impact hit;
  const double turning = turning_speeds(a, b, h);
  double span = h;  // to look ahead by, s
  for (int look = 0; look < 200; ++look) {
    hit.a = pose_after(a, hit.time);
    hit.b = pose_after(b, hit.time);
    const SignedPair r = distance(hit.a.to_local(hit.b), guess);
    if (!std::isfinite(r.distance) || !is_finite(r.normal)) return {};
    hit.normal_in_a = guess = r.normal;
    if (r.distance <= target) {
      hit.is_found = look > 0;
      hit.is_now = look == 0;
      return hit;
    }
    const double closing = dot(hit.a.rotation * r.normal, a.velocity - b.velocity) + turning;
    if (!(closing > 0)) return {};
    const double step = r.distance / closing, from = hit.time;
    hit.time += step;
    if (!(hit.time < h)) return {};
    if (look < 2 || !(span > 4 * step)) continue;
    span = std::min(span, h - from);
    const Pose there = pose_after(a, from + span);
    const SignedPair then = distance(there.to_local(pose_after(b, from + span)), guess);
    const double enough =
        (1 + 1e-6) * target + dip(a, b, hit.a.rotation * r.normal, there.rotation * then.normal, span, h);
    if (!(r.distance > enough && then.distance > enough)) {
      span /= 4;
    } else if (from + span < h) {
      hit.time = from + span, span *= 2;
    } else {
      return {};
    }
  }
  hit.is_found = true;
  return hit;
}
/// The same of two convex shapes, one of which may be a half-space.
inline Impact time_of_impact(const Collider& a, const Collider& b, double h, double scale, double target, const Vec3& first = zero<Vec3>()) {
  Patch patch;
  const bool is_round = is_round_pair(a.shape, b.shape);
  return time_of_impact(a, b, h, target, first, [&](const Pose& b_in_a, const Vec3& guess) {
    constexpr double infinity = std::numeric_limits<double>::infinity();
    if (SignedPair r; is_round && one_point(a.shape, b.shape, b_in_a, infinity, scale, r)) return r;
    return distance_of(a.shape, b.shape, b_in_a, infinity, scale, guess, patch);
  });
}

}  // namespace delassus::inner
