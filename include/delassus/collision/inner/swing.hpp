/// The next point of a body that its turn brings to a plane.
#pragma once

#include <delassus/collision/inner/time_of_impact.hpp>

#include <algorithm>

namespace delassus::inner {

inline bool is_turning(const Collider& c) {
  return c.shape.kind != ShapeKind::sphere && !is_zero(c.angular_velocity);
}

/// A point of a turning body that comes to a plane.
struct Swing {
  bool is_found = false;
  double time = 0;          ///< s from now
  Vec3 arm = zero<Vec3>();  ///< from the body's middle to the point then
};

/// When the lowest point of a body along `up` first sinks under the plane up · x = height by `target` more
/// than it is now, looked for every 0.05 rad of its turn, and then the place where it met the plane.
inline Swing swing_to_plane(const Collider& body, const Vec3& up, double height, double h, double target) {
  Swing s;
  const auto lowest = [&](double t) {
    const Pose pose = pose_after(body, t);
    s.arm = pose.rotation * support(body.shape, Vec3(-transposed_times(pose.rotation, up)));
    return dot(up, pose.position + s.arm) - height;
  };
  const double level = std::min(lowest(0), 0.0) - target;
  const int looks = int(std::clamp(norm(body.angular_velocity) * h / 0.05, 1.0, 200.0)) + 1;
  for (int look = 1; look <= looks && !s.is_found; ++look) {
    s.time = h * look / looks;
    s.is_found = lowest(s.time) < level;
  }
  if (!s.is_found) return s;
  double before = s.time - h / looks, after = s.time;
  for (int halving = 0; halving < 30; ++halving) {
    const double middle = 0.5 * (before + after);
    (lowest(middle) < level ? after : before) = middle;
  }
  s.time = before;
  (void)lowest(before);
  return s;
}

/// Whether the point meets the other body, and not its plane beyond the rim alone. Both stand still but for
/// `body`.
inline bool meets(const Collider& other, const Collider& body, const Swing& swing) {
  const double scale = pair_scale(other.shape, body.shape), near = 5e-3 * scale;
  const Pose point{.position = body.pose.position + swing.time * body.velocity + swing.arm};
  Patch patch;
  const SignedPair r =
      distance_of(other.shape, Sphere{near}, other.pose.to_local(point), scale, near, zero<Vec3>(), patch);
  return r.status == PairStatus::near && r.distance < near;
}

}  // namespace delassus::inner
