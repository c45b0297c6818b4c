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

/// No point of the body is faster than this, m/s.
inline double top_speed(const Collider& c) {
  return norm(c.velocity) + norm(c.angular_velocity) * outer_radius(c.shape);
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
