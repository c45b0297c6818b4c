/// A plane that proves that two moving shapes do not meet for a while.
#pragma once

#include <delassus/collision/collider.hpp>
#include <delassus/collision/half_space.hpp>
#include <delassus/core/cmath.hpp>
#include <delassus/geometry/support.hpp>
#include <delassus/geometry/triangle.hpp>

#include <limits>

namespace delassus::inner {

/// How high a body reaches along a direction, above the origin of its pose: now, and after h s by the first
/// order of its turn. `bend` bounds what the second order adds in between. m.
struct Heights {
  double now, then, bend;
};

/// How high the shape reaches along d, of any length, above the origin of its pose, m.
template <class S>
[[gnu::always_inline]] inline double height_of(const S& s, const Pose& pose, const Vec3& d) {
  const Vec3 local = transposed_times(pose.rotation, d);
  return dot(local, core_support(s, local)) + core_radius(s) * norm(d);
}

/// The points x = c + p of a body that turns by ω stand along n at n · p, and rise by n · (ω × p) = p · (n ×
/// ω). So after h s they are at p · m, m = n + h n × ω, to within h² |n × ω| |ω| r / 2. `radius` is r, of the
/// ball about c that holds the shape.
template <class S>
[[gnu::always_inline]] inline Heights heights_of(const S& s, const Pose& pose, const Vec3& omega,
                                                 double radius, const Vec3& n, double h) {
  const Vec3 turn = h * cross(n, omega);
  Heights up{.now = height_of(s, pose, n), .then = 0, .bend = 0};
  up.then = up.now;
  if (is_zero(turn)) return up;
  up.then = height_of(s, pose, Vec3(n + turn));
  up.bend = 0.5 * h * norm(turn) * norm(omega) * radius;
  return up;
}
/// The same of a shape; a ball stays where it is. Without a bound for a half-space that turns, or along
/// another direction than its own.
inline Heights heights_of(const Shape& s, const Pose& pose, const Vec3& omega, const Vec3& n, double h) {
  if (s.kind == ShapeKind::sphere) return {s.size[0], s.size[0], 0};
  if (s.kind != ShapeKind::half_space) return heights_of(s, pose, omega, outer_radius(s), n, h);
  const Plane plane = plane_of(s, pose);
  const double height = plane.offset - dot(plane.normal, pose.position);
  const bool is_along = is_zero(omega) && squared_norm(plane.normal - n) <= 1e-28;
  return {height, height, is_along ? 0 : std::numeric_limits<double>::infinity()};
}

/// True where the plane across the unit vector n, which goes along with both, keeps A (below) and B farther
/// apart than `target` m for h s. Each point's distance along n leaves its chord by `bend` at most, and the
/// least of many lies above the chord of its ends. `apart` goes from the place of A to that of B, `closing`
/// is their approach along n, m/s.
[[gnu::always_inline]] inline bool plane_parts(const Heights& a, const Heights& b, double apart,
                                               double closing, double h, double target) {
  const double now = apart - a.now - b.now, then = apart - closing * h - a.then - b.then;
  const double enough =
      target + a.bend + b.bend + 1e-9 * (std::abs(a.now) + std::abs(b.now)) + 1e-12 * std::abs(apart);
  return now > enough && then > enough;
}

/// The same for colliders, posed where they are.
inline bool stay_apart(const Collider& a, const Collider& b, const Vec3& n, double h, double target) {
  return plane_parts(heights_of(a.shape, a.pose, a.angular_velocity, n, h),
                     heights_of(b.shape, b.pose, b.angular_velocity, Vec3(-n), h),
                     dot(n, Vec3(b.pose.position - a.pose.position)), dot(n, Vec3(a.velocity - b.velocity)),
                     h, target);
}
/// The same of one triangle of a surface.
inline bool stay_apart(const Triangle& t, const Collider& a, const Collider& b, const Vec3& n, double h,
                       double target) {
  return plane_parts(heights_of(t, a.pose, a.angular_velocity, outer_radius(a.shape), n, h),
                     heights_of(b.shape, b.pose, b.angular_velocity, Vec3(-n), h),
                     dot(n, Vec3(b.pose.position - a.pose.position)), dot(n, Vec3(a.velocity - b.velocity)),
                     h, target);
}

}  // namespace delassus::inner
