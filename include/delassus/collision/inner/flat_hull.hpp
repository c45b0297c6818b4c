/// The corners of the convex hull of points that lie in one plane, or are seen along a direction.
#pragma once

#include <delassus/core/array.hpp>
#include <delassus/core/cmath.hpp>
#include <delassus/core/index.hpp>
#include <delassus/core/sort.hpp>
#include <delassus/math/linear.hpp>

#include <algorithm>
#include <cstddef>

namespace delassus::inner {

/// Its arrays keep their capacity.
class FlatHull {
 public:
  /// Sees the points at(0) … at(count − 1) along the unit vector n.
  template <class At>
  void project(Index count, const At& at, const Vec3& n) {
    const Vec3 u = normalized(cross(n, unit_axis(std::abs(n[0]) < 0.6 ? 0 : 1))), v = cross(n, u);
    place_.clear();
    for (Index i = 0; i < count; ++i) place_.push_back({dot(u, at(i)), dot(v, at(i))});
  }

  /// Of the points in `order`, which it sorts: the corners, counter-clockwise about n. A point between its neighbours that stands
  /// out from them by less than `flat` m is none: it lies along a side, but for rounding. Source: [Andrew1979].
  const Array<Index>& find(Array<Index>& order, double flat) {
    inner::sort(order, [&](Index i, Index j) {
      const Place &p = place_[i], &q = place_[j];
      return p.x != q.x ? p.x < q.x : p.y != q.y ? p.y < q.y : i < j;
    });
    hull_.clear();
    const auto extend = [&](Index i, std::size_t base) {
      while (hull_.size() >= base + 2 && turn(hull_[hull_.size() - 2], hull_.back(), i) <= 0)
        hull_.pop_back();
      hull_.push_back(i);
    };
    for (const Index i : order) extend(i, 0);
    const std::size_t base = hull_.size() - 1;
    for (std::size_t k = order.size(); k-- > 0;) extend(order[k], base);
    hull_.pop_back();
    if (hull_.empty()) hull_.push_back(order[0]);
    straighten(flat);
    return hull_;
  }

  /// How far point i lies outside of the convex polygon `corners`, counter-clockwise, m; below 0: inside.
  double outside(Index i, const Array<Index>& corners) const {
    double farthest = -1e300;
    for (std::size_t k = 0; k < corners.size(); ++k) {
      const Index j = corners[k], l = corners[k + 1 < corners.size() ? k + 1 : 0];
      const Place &a = place_[j], &b = place_[l];
      const double length = std::hypot(b.x - a.x, b.y - a.y);
      if (length > 0) farthest = std::max(farthest, -turn(j, l, i) / length);
    }
    return farthest;
  }

 private:
  struct Place {
    double x, y;
  };

  /// Twice the area of the triangle of three points, positive when they turn left.
  double turn(Index i, Index j, Index k) const {
    const Place &a = place_[i], &b = place_[j], &c = place_[k];
    return (b.x - a.x) * (c.y - a.y) - (b.y - a.y) * (c.x - a.x);
  }

  void straighten(double flat) {
    std::size_t kept = 0;
    for (std::size_t k = 0; k < hull_.size(); ++k) {
      const Index before = kept > 0 ? hull_[kept - 1] : hull_.back(), i = hull_[k],
                  after = k + 1 < hull_.size() ? hull_[k + 1] : hull_[0];
      const Place &a = place_[before], &b = place_[i], &c = place_[after];
      const bool is_between = (b.x - a.x) * (c.x - b.x) + (b.y - a.y) * (c.y - b.y) >= 0;
      if (is_between && std::abs(turn(before, i, after)) <= flat * std::hypot(c.x - a.x, c.y - a.y)) continue;
      hull_[kept++] = i;
    }
    hull_.resize(std::max(kept, std::size_t(1)));
  }

  Array<Place> place_;
  Array<Index> hull_;
};

}  // namespace delassus::inner
