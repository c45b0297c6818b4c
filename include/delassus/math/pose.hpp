/// Where a body is and how it is turned.
#pragma once

#include <delassus/math/linear.hpp>

namespace delassus {

/// x_world = position + rotation · x_local. Lengths in m; `rotation` is orthonormal.
struct Pose {
  Vec3 position = zero<Vec3>();
  Mat3 rotation = identity<Mat3>();

  Vec3 to_world(const Vec3& local) const { return position + rotation * local; }
  Vec3 to_local(const Vec3& world) const { return transposed_times(rotation, world - position); }
  /// Where the other one is, in the frame of this.
  Pose to_local(const Pose& other) const {
    return {to_local(other.position), transposed_times(rotation, other.rotation)};
  }
};

}  // namespace delassus
