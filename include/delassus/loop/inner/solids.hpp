/// Whether two shapes of a scene without contact laws overlap: a rough answer, for a warning.
#pragma once

#include <delassus/core/array.hpp>
#include <delassus/core/index.hpp>
#include <delassus/core/sort.hpp>
#include <delassus/geometry/support.hpp>
#include <delassus/math/linear.hpp>
#include <delassus/math/pose.hpp>

#include <algorithm>
#include <cstddef>
#include <cstdint>

namespace delassus::inner {

/// A rigid body or particle with a shape.
struct Solid {
  Shape shape;
  Pose pose;
  double radius;  ///< of a ball around it, m; 0 of a half-space
  std::uint32_t group, collides_with;
  Index set, block;
  bool moves;  ///< or may be moved

  bool is_endless() const { return shape.kind == ShapeKind::half_space; }
  double first() const { return pose.position[0] - radius; }
};

/// The share of a shape that must meet the same share of another: shapes that touch do not overlap.
inline constexpr double inner_share = 0.98;

/// The point of the share farthest along a direction, world, m.
inline Vec3 farthest_of_share(const Solid& s, const Vec3& direction) {
  const Vec3 n = transposed_times(s.pose.rotation, direction);
  return s.pose.to_world(Vec3(inner_share * support(s.shape, n)));
}

inline bool reaches_below(const Solid& ground, const Solid& s) {
  const Vec3 normal(ground.shape.size[0], ground.shape.size[1], ground.shape.size[2]);
  const Vec3 lowest = ground.pose.to_local(farthest_of_share(s, Vec3(-(ground.pose.rotation * normal))));
  return dot(normal, lowest) < ground.shape.size[3];
}

/// Whether the shares of two convex shapes have a common point. The nearest point of their difference to the origin is walked
/// to by segments; a plane between them ends the walk. What two hundred segments leave open counts as apart.
/// Source: [Gilbert1966].
inline bool shares_meet(const Solid& a, const Solid& b) {
  Vec3 v = a.pose.position - b.pose.position;
  const double size = a.radius + b.radius;
  for (int k = 0; k < 200; ++k) {
    const double length = norm(v);
    if (!(length > 1e-4 * size)) return true;
    const Vec3 n = -(v / length), w = farthest_of_share(a, n) - farthest_of_share(b, Vec3(-n));
    if (dot(n, w) < 0) return false;
    const Vec3 way = w - v;
    const double share = -dot(v, way) / squared_norm(way);
    if (!(share > 0)) return true;
    v += std::min(share, 1.0) * way;
  }
  return false;
}

inline bool are_apart_by_rule(const Solid& a, const Solid& b) {
  return (!a.moves && !b.moves) || (a.group & b.collides_with) == 0 || (b.group & a.collides_with) == 0;
}

inline bool overlap(const Solid& a, const Solid& b) {
  if (are_apart_by_rule(a, b) || (a.is_endless() && b.is_endless())) return false;
  if (a.is_endless()) return reaches_below(a, b);
  if (b.is_endless()) return reaches_below(b, a);
  return norm(Vec3(a.pose.position - b.pose.position)) < a.radius + b.radius && shares_meet(a, b);
}

/// Two shapes of a scene.
struct SolidPair {
  Index set_a = -1, block_a = -1, set_b = -1, block_b = -1;
  explicit operator bool() const { return set_a >= 0; }
};

/// The pairs of a scene that overlap, one after the other. A template, so that a program can compile it once.
template <class S>
class Overlaps {
 public:
  void add(const Shape& shape, const Pose& pose, std::uint32_t group, std::uint32_t collides_with, Index set, Index block, bool moves);
  /// The first pair once all are added, then the next; none is left where it is false.
  SolidPair next();

 private:
  Array<S> solids_;
  std::size_t i_ = 0, j_ = 0;
};

template <class S>
void Overlaps<S>::add(const Shape& shape, const Pose& pose, std::uint32_t group, std::uint32_t collides_with, Index set, Index block, bool moves) {
  if (!shape.is_kept() && is_finite(pose.position))
    solids_.push_back({shape, pose, outer_radius(shape), group, collides_with, set, block, moves});
}
template <class S>
SolidPair Overlaps<S>::next() {
  if (j_ == 0)
    sort(solids_.data(), solids_.data() + solids_.size(), [](const S& a, const S& b) {
      return a.is_endless() != b.is_endless() ? a.is_endless() : a.first() < b.first();
    });
  for (; i_ < solids_.size(); ++i_, j_ = i_)
    while (++j_ < solids_.size()) {
      const S &a = solids_[i_], &b = solids_[j_];
      if (!a.is_endless() && b.first() > a.pose.position[0] + a.radius) break;
      if (overlap(a, b)) return {a.set, a.block, b.set, b.block};
    }
  return {};
}

}  // namespace delassus::inner
