/// What all pairs of a collider ask of it, so that it is found once a step.
#pragma once

#include <delassus/collision/collider.hpp>
#include <delassus/core/bits.hpp>
#include <delassus/core/cmath.hpp>
#include <delassus/geometry/support.hpp>

#include <algorithm>
#include <cstdint>
#include <limits>

namespace delassus::inner {

/// A number for what a shape is, the same wherever the shape lies in memory.
inline std::uint64_t fingerprint(const Shape& s) {
  std::uint64_t sum = std::uint64_t(s.kind) + 1;
  const auto mix = [&](double x) { sum = (sum ^ inner::bits_as<std::uint64_t>(x)) * 0x9e3779b97f4a7c15ull; };
  if (s.kind == ShapeKind::convex_hull) {
    sum = (sum ^ s.hull->fingerprint()) * 0x9e3779b97f4a7c15ull;
  } else {
    for (const double x : s.size) mix(x);
  }
  return sum ^ sum >> 29;
}

/// No point of the body is faster than this, m/s: a half-space that turns has points of any speed.
inline double top_speed(const Collider& c) {
  if (c.shape.kind == ShapeKind::half_space && !is_zero(c.angular_velocity)) return std::numeric_limits<double>::infinity();
  return norm(c.velocity) + norm(c.angular_velocity) * outer_radius(c.shape);
}

/// No point at which the two may meet within h s goes faster by the turn of `c` alone, m/s. A ball that turns stays where it is.
inline double turning_speed(const Collider& c, const Collider& other, double h) {
  if (c.shape.kind == ShapeKind::sphere || is_zero(c.angular_velocity)) return 0;
  const double radius = c.shape.kind != ShapeKind::half_space
                            ? outer_radius(c.shape)
                            : norm(Vec3(other.pose.position - c.pose.position)) + outer_radius(other.shape) + h * norm(Vec3(other.velocity - c.velocity));
  return norm(c.angular_velocity) * radius;
}
/// The sum of both.
inline double turning_speeds(const Collider& a, const Collider& b, double h) { return turning_speed(a, b, h) + turning_speed(b, a, h); }

/// The size that a shape brings to its pairs, m, of which the smaller one counts: a half-space leaves it to
/// the other.
inline double scale_in_pairs(const Shape& s) {
  return s.kind == ShapeKind::half_space ? std::numeric_limits<double>::infinity() : length_scale(s);
}
inline double pair_scale(const Shape& a, const Shape& b) {
  return std::min(scale_in_pairs(a), scale_in_pairs(b));
}

/// How far from its origin the turn of a shape moves what may touch, m: of a ball nothing, of a half-space any distance.
inline double turning_radius(const Shape& s) {
  if (s.kind == ShapeKind::half_space) return std::numeric_limits<double>::infinity();
  return s.kind == ShapeKind::sphere ? 0 : outer_radius(s);
}

/// No two points that touch close in faster than this, m/s, for the `turning_radius` of each. Two that ride on what moves or turns
/// are at rest for each other.
inline double closing_speed(const Collider& a, const Collider& b, double radius_a, double radius_b) {
  const bool is_a = radius_a < radius_b;
  const Collider &small = is_a ? a : b, &large = is_a ? b : a;
  const double radius = is_a ? radius_a : radius_b, far = is_a ? radius_b : radius_a;
  const double seen_from_small = norm(Vec3(small.velocity - large.velocity_at(small.pose.position))) +
                                 norm(Vec3(small.angular_velocity - large.angular_velocity)) * radius;
  if (!std::isfinite(far)) return seen_from_small;
  return std::min(seen_from_small, norm(Vec3(b.velocity - a.velocity)) + norm(small.angular_velocity) * radius +
                                       norm(large.angular_velocity) * far);
}
inline double closing_speed(const Collider& a, const Collider& b) {
  return closing_speed(a, b, turning_radius(a.shape), turning_radius(b.shape));
}

struct Summary {
  double scale = 0;         ///< `scale_in_pairs`, m
  double radius = 0;        ///< `turning_radius`, m
  double speed = 0;         ///< `top_speed`, m/s
  std::uint64_t shape = 0;  ///< its fingerprint
  double way = 0;           ///< `longest_way` of a detection that looks ahead, m
};

inline Summary summary_of(const Collider& c) {
  return {.scale = scale_in_pairs(c.shape), .radius = turning_radius(c.shape), .speed = top_speed(c), .shape = fingerprint(c.shape)};
}

}  // namespace delassus::inner
