/// A few colliders and the contacts the native backend finds between them.
#pragma once

#include <delassus/collision/native_engine.hpp>
#include <delassus/collision/native.hpp>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <set>
#include <vector>

namespace scenes {

using namespace delassus;

template <class Backend>
struct SceneOf {
  Backend collision{};
  std::vector<Collider> colliders{};
  std::vector<ContactPoint> contacts{};
  CollisionReport report{};

  Collider& add(const Shape& shape, const Vec3& position, const Mat3& rotation = Mat3::Identity(),
                bool is_movable = true) {
    const auto key = std::uint32_t(colliders.size());
    colliders.push_back({.shape = shape, .pose = {position, rotation}, .is_movable = is_movable, .key = key});
    return colliders.back();
  }
  void detect(double h = 1e-3) { report = collision.detect(colliders, h, contacts); }
  /// As a loop asks, with the pairs that pushed in the last step: contacts where bodies meet.
  void detect_ahead(double h, const std::set<std::uint64_t>& pushed = {}) {
    report = collision.detect(colliders, h, contacts, Pushed{pushed});
  }
  /// Those of the pairs left out that meet by the velocities which the colliders have now.
  std::vector<ContactPoint> missed(double h, const std::set<std::uint64_t>& pushed = {}) {
    std::vector<ContactPoint> found;
    collision.detect_missed(colliders, h, found, Pushed{pushed});
    return found;
  }
  struct Pushed {
    const std::set<std::uint64_t>& pairs;
    bool lets(std::uint64_t) const { return true; }
    bool pushed(std::uint64_t pair) const { return pairs.count(pair) > 0; }
  };
};
using Scene = SceneOf<NativeCollision>;

inline Mat3 turned(double angle, const Vec3& axis) {
  return Eigen::AngleAxisd(angle, axis.normalized()).toRotationMatrix();
}

inline ConvexHull cube_hull(double edge = 1) {
  std::vector<Vec3> corners;
  for (int i = 0; i < 8; ++i)
    corners.push_back(edge * Vec3(i & 1 ? 0.5 : -0.5, i & 2 ? 0.5 : -0.5, i & 4 ? 0.5 : -0.5));
  return ConvexHull(corners);
}

/// Of the convex polygon with these corners, seen along z.
inline double area(std::vector<Vec3> points) {
  Vec3 centre = Vec3::Zero();
  for (const Vec3& p : points) centre += p / double(points.size());
  std::sort(points.begin(), points.end(), [&](const Vec3& p, const Vec3& q) {
    return std::atan2(p[1] - centre[1], p[0] - centre[0]) < std::atan2(q[1] - centre[1], q[0] - centre[0]);
  });
  double sum = 0;
  for (std::size_t i = 0; i < points.size(); ++i)
    sum += (points[i] - centre).cross(points[(i + 1) % points.size()] - centre)[2] / 2;
  return sum;
}

}  // namespace scenes
