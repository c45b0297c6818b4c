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

/// Any rotation, or one of those by quarter turns, where faces and edges are parallel.
inline Quat rotation(Bytes& bytes) {
  constexpr double s = 0.70710678118654752;
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
  Shape any(Bytes& bytes, double size, double stretch, bool with_half_spaces) {
    const auto length = [&] { return size * bytes.magnitude(-stretch, 0); };
    const double a = length(), b = length(), c = length();
    switch (bytes.below(with_half_spaces ? 8 : 7)) {
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
        return HalfSpace{vector(bytes, 1), bytes.between(-1, 1)};
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
