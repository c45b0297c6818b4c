/// Shapes, sizes and poses out of a fuzzer's bytes.
#pragma once

#include "bytes.hpp"

#include <delassus/geometry/convex_hull.hpp>
#include <delassus/geometry/shape.hpp>
#include <delassus/math/pose.hpp>
#include <delassus/math/rotation.hpp>

#include <deque>
#include <vector>

namespace fuzz {

using namespace delassus;

inline Vec3 vector(Bytes& bytes, double size, bool is_wild = false) {
  Vec3 v;
  for (int k = 0; k < 3; ++k) v[k] = bytes.number(size, is_wild);
  return v;
}

/// Any rotation, or one of those by quarter turns, where faces and edges are parallel; or now and then none
/// at all where `is_wild`.
inline Quat rotation(Bytes& bytes, bool is_wild = false) {
  constexpr double s = 0.70710678118654752;
  if (is_wild && bytes.chance(32)) {
    const double w = bytes.odd(), x = bytes.odd();
    return Quat(w, x, 0, 0);
  }
  switch (bytes.below(4)) {
    case 0:
      return Quat::Identity();
    case 1:
      return Quat(s, s, 0, 0);
    case 2:
      return Quat(s, 0, 1e-9 * bytes.below(16), s).normalized();
    default:
      return exponential<double>(vector(bytes, 3));
  }
}

/// Keeps the hulls of its shapes.
class Shapes {
 public:
  /// A shape of about `size`; `stretch` is how far its lengths may differ, in powers of ten. May be refused.
  Shape any(Bytes& bytes, double size, double stretch, bool with_half_spaces, bool is_wild = false) {
    const auto length = [&] { return size * bytes.magnitude(-stretch, 0); };
    double a = length();
    const double b = length(), c = length();
    const int kind = bytes.below(with_half_spaces ? 8 : 7);
    if (is_wild && kind < 7 && bytes.chance(77)) a = bytes.odd();
    switch (kind) {
      case 0:
        return Sphere{a};
      case 1:
        return Box{a, b, c};
      case 2:
        return Capsule{a, b};
      case 3:
        return Cylinder{a, b};
      case 4:
        return Cone{a, b};
      case 5:
        return Ellipsoid{a, b, c};
      case 6:
        return hull(bytes, Vec3(a, b, c));
      default:
        return HalfSpace{vector(bytes, 1, is_wild), bytes.between(-1, 1)};
    }
  }

 private:
  /// Of four to eleven points on a grid of nine steps an edge: many lie in one plane.
  Shape hull(Bytes& bytes, const Vec3& half) {
    std::vector<Vec3> points(std::size_t(4 + bytes.below(8)));
    for (Vec3& p : points)
      for (int k = 0; k < 3; ++k) p[k] = half[k] * (bytes.below(9) - 4) / 4;
    return hulls_.emplace_back(ConvexHull(points).centred());
  }

  std::deque<ConvexHull> hulls_;
};

}  // namespace fuzz
