/// The plane of a half-space.
#pragma once

#include <delassus/geometry/shape.hpp>
#include <delassus/math/linear.hpp>
#include <delassus/math/pose.hpp>

namespace delassus {

/// A plane in the frame of A: the solid is normal · x ≤ offset.
struct Plane {
  Vec3 normal;    ///< out of the solid, of length 1
  double offset;  ///< m, along the normal
};

namespace inner {

inline Plane plane_of(const Shape& s, const Pose& pose) {
  const Vec3 n = pose.rotation * Vec3(s.size[0], s.size[1], s.size[2]);
  return {n, s.size[3] + dot(n, pose.position)};
}

}  // namespace inner
}  // namespace delassus
