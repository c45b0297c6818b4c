/// A box whose edges are along the axes of the world.
#pragma once

#include <delassus/core/cmath.hpp>
#include <delassus/math/linear.hpp>

#include <limits>

namespace delassus {

/// All points with min ≤ x ≤ max, m; empty where some min is above its max.
class Aabb {
 public:
  /// Empty; what it is extended by it becomes.
  Aabb() : min_(most, most, most), max_(-most, -most, -most) {}
  [[gnu::always_inline]] Aabb(const Vec3& min, const Vec3& max) : min_(min), max_(max) {}
  [[gnu::always_inline]] explicit Aabb(const Vec3& point) : min_(point), max_(point) {}

  [[gnu::always_inline]] const Vec3& min() const { return min_; }
  [[gnu::always_inline]] const Vec3& max() const { return max_; }
  [[gnu::always_inline]] Vec3& min() { return min_; }
  [[gnu::always_inline]] Vec3& max() { return max_; }

  // Asked axis by axis, since the first one mostly tells.
  bool is_empty() const {
    const double *low = min_.data(), *high = max_.data();
    return low[0] > high[0] || low[1] > high[1] || low[2] > high[2];
  }
  /// Whether there is no point in both. An empty one is apart from all but the infinite.
  bool is_apart(const Aabb& o) const {
    const double *low = min_.data(), *high = max_.data(), *o_low = o.min_.data(), *o_high = o.max_.data();
    return low[0] > o_high[0] || o_low[0] > high[0] || low[1] > o_high[1] || o_low[1] > high[1] || low[2] > o_high[2] ||
           o_low[2] > high[2];
  }
  [[gnu::always_inline]] bool intersects(const Aabb& o) const { return !is_apart(o); }
  /// Whether all of the other is in this; an empty one is in every box.
  bool contains(const Aabb& o) const {
    const double *low = min_.data(), *high = max_.data(), *o_low = o.min_.data(), *o_high = o.max_.data();
    return low[0] <= o_low[0] && low[1] <= o_low[1] && low[2] <= o_low[2] && o_high[0] <= high[0] && o_high[1] <= high[1] &&
           o_high[2] <= high[2];
  }

  /// The box around both.
  Aabb& extend(const Aabb& o) {
    double *low = min_.data(), *high = max_.data();
    const double *o_low = o.min_.data(), *o_high = o.max_.data();
    for (int k = 0; k < 3; ++k) {
      if (o_low[k] < low[k]) low[k] = o_low[k];
      if (o_high[k] > high[k]) high[k] = o_high[k];
    }
    return *this;
  }
  [[gnu::always_inline]] Aabb& extend(const Vec3& point) { return extend(Aabb(point)); }

  Vec3 sizes() const { return max_ - min_; }
  Vec3 center() const { return (min_ + max_) / 2; }
  /// m; zero inside.
  double distance(const Vec3& point) const {
    double square = 0;
    for (int k = 0; k < 3; ++k) {
      const double out = point[k] < min_[k] ? min_[k] - point[k] : point[k] > max_[k] ? point[k] - max_[k] : 0.0;
      square += out * out;
    }
    return std::sqrt(square);
  }

 private:
  static constexpr double most = std::numeric_limits<double>::max();
  Vec3 min_, max_;
};

}  // namespace delassus
