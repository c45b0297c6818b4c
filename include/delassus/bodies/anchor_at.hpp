/// Anchors told by a place in the world.
#pragma once

#include <delassus/bodies/world.hpp>

namespace delassus {

/// The material point of a body that is at `point` (world, m) now, with a joint frame that is turned like
/// `frame` (world) now: the two ends of a joint from one place.
template <BodySet S>
Anchor anchor_at(const S& set, typename S::Handle body, const Vec3& point,
                 const Quat& frame = Quat::Identity()) {
  Anchor a = anchor(set, body);
  if constexpr (FramedSet<S>) {
    const Quat turn = set.orientation(body);
    return anchor(set, body, turn.conjugate() * (point - set.position(body)), turn.conjugate() * frame);
  }
  return a;
}

/// The turn that takes z to `axis`, for the frame of a hinge or a slider. Any length but zero.
inline Quat frame_along(const Vec3& axis) {
  DELASSUS_EXPECT(is_finite(axis) && axis.norm() > 0, "frame_along: the axis must be finite and not zero");
  return Quat::FromTwoVectors(unit_axis(2), axis);
}

}  // namespace delassus
