/// Anchors told by a place in the world.
#pragma once

#include <delassus/bodies/world.hpp>
#include <delassus/math/rotation.hpp>

#include <type_traits>

namespace delassus {

/// The material point of a body that is at `point` (world, m) now. Its joint frame is turned like `frame` (world)
/// now. Called for both bodies it gives the two ends of a joint from one place.
template <BodySet S>
Anchor anchor_at(const S& set, typename S::Handle body, const Vec3& point,
                 const Quat& frame = Quat::Identity()) {
  Anchor a = anchor(set, body);
  if constexpr (FramedSet<S>) {
    const Quat back = conjugate<double>(set.orientation(body));
    return anchor(set, body, rotated<double>(back, Vec3(point - set.position(body))), product(back, frame));
  }
  return a;
}

/// The turn that takes z to `axis`, for the frame of a hinge or a slider. Any length but zero. With e the unit vector,
///
///   q = (1 + e_z, z × e) normalised, 1 + e_z = (e_x² + e_y²)/(1 − e_z) where e points down.
///
/// It is (0, x) where rounding cannot tell e from −z.
template <class Scalar = double>
Quat frame_along(const std::type_identity_t<Vec<3, Scalar>>& axis) {
  DELASSUS_EXPECT(is_finite(axis) && norm(axis) > 0, "frame_along: the axis must be finite and not zero");
  const Vec<3, Scalar> e = axis / norm(axis);
  const Scalar flat = e[0] * e[0] + e[1] * e[1];
  if (e[2] < 0 && flat < 1e-32) return Eigen::Quaternion<Scalar>(0, 1, 0, 0);
  return unit(Eigen::Quaternion<Scalar>(e[2] < 0 ? flat / (1 - e[2]) : 1 + e[2], -e[1], e[0], 0));
}

}  // namespace delassus
