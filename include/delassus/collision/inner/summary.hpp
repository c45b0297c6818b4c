/// What all pairs of a collider ask of it, so that it is found once a step.
#pragma once

#include <delassus/collision/collider.hpp>
#include <delassus/core/bits.hpp>
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

/// No point at which the two may meet within h s is faster than this by the motion of `c`, m/s.
inline double top_speed(const Collider& c, const Collider& other, double h) {
  return c.shape.kind == ShapeKind::half_space ? norm(c.velocity) + turning_speed(c, other, h) : top_speed(c);
}

/// The size that a shape brings to its pairs, m, of which the smaller one counts: a half-space leaves it to
/// the other.
inline double scale_in_pairs(const Shape& s) {
  return s.kind == ShapeKind::half_space ? std::numeric_limits<double>::infinity() : length_scale(s);
}
inline double pair_scale(const Shape& a, const Shape& b) {
  return std::min(scale_in_pairs(a), scale_in_pairs(b));
}

struct Summary {
  double scale = 0;         ///< `scale_in_pairs`, m
  double speed = 0;         ///< `top_speed`, m/s
  std::uint64_t shape = 0;  ///< its fingerprint
  double way = 0;           ///< `longest_way` of a detection that looks ahead, m
};

inline Summary summary_of(const Collider& c) {
  return {.scale = scale_in_pairs(c.shape), .speed = top_speed(c), .shape = fingerprint(c.shape)};
}

}  // namespace delassus::inner
