/// Of many contact points with nearly one normal, those that carry: the outermost and the deepest.
#pragma once

#include <delassus/collision/manifold.hpp>
#include <delassus/core/array.hpp>
#include <delassus/core/cmath.hpp>
#include <delassus/core/fixed_array.hpp>
#include <delassus/core/sort.hpp>

#include <algorithm>
#include <limits>
#include <span>

namespace delassus::inner {

/// A contact of a surface, with its own normal. `point.a` is on the surface.
struct SurfaceContact {
  PatchPoint point;
  Vec3 normal;
  Index triangle = -1;
  bool is_ahead = false;  ///< of the place where the two will meet
};

/// Chooses among contacts of one group, seen along its normal n. Its arrays keep their capacity.
class HullOfPatch {
 public:
  /// Fills `patch` from the points, and `source` with the place of each in `points`: the convex hull of those
  /// within 1e-3 of the scale of the deepest, and of all of them when these are fewer than four. The hull is the area that
  /// touches; sides that are chords of `round` stand for its rim.
  void choose(std::span<const SurfaceContact> points, const Vec3& n, double scale, const RoundFace& round, Patch& patch,
              FixedArray<Index, Patch::capacity>& source) {
    project(points, n);
    Index deepest = 0;
    for (Index i = 1; i < Index(points.size()); ++i)
      if (points[i].point.gap < points[deepest].point.gap) deepest = i;
    patch.clear();
    for (const double reach : {1e-3 * scale, std::numeric_limits<double>::infinity()}) {
      order_.clear();
      for (Index i = 0; i < Index(points.size()); ++i)
        if (points[i].point.gap <= points[deepest].point.gap + reach) order_.push_back(i);
      find_hull();
      straighten(1e-5 * scale);
      take(points, scale, patch, source);
      patch.area = area_of_patch(patch, n, round);
      add_deepest(points, deepest, scale, patch, source);
      if (patch.count >= 4) return;
    }
  }

 private:
  struct Place {
    double x, y;
  };

  void project(std::span<const SurfaceContact> points, const Vec3& n) {
    const Vec3 u = normalized(cross(n, unit_axis(std::abs(n[0]) < 0.6 ? 0 : 1))), v = cross(n, u);
    place_.clear();
    for (const SurfaceContact& p : points) place_.push_back({dot(u, p.point.a), dot(v, p.point.a)});
  }

  /// Twice the area of the triangle of three points, positive when they turn left.
  double turn(Index i, Index j, Index k) const {
    const Place &a = place_[i], &b = place_[j], &c = place_[k];
    return (b.x - a.x) * (c.y - a.y) - (b.y - a.y) * (c.x - a.x);
  }

  /// Andrew's monotone chain over `order_` [Andrew1979].
  void find_hull() {
    inner::sort(order_, [&](Index i, Index j) {
      const Place &p = place_[i], &q = place_[j];
      return p.x != q.x ? p.x < q.x : p.y != q.y ? p.y < q.y : i < j;
    });
    hull_.clear();
    const auto extend = [&](Index i, std::size_t base) {
      while (hull_.size() >= base + 2 && turn(hull_[hull_.size() - 2], hull_.back(), i) <= 0)
        hull_.pop_back();
      hull_.push_back(i);
    };
    for (const Index i : order_) extend(i, 0);
    const std::size_t base = hull_.size() - 1;
    for (std::size_t k = order_.size(); k-- > 0;) extend(order_[k], base);
    hull_.pop_back();
    if (hull_.empty()) hull_.push_back(order_[0]);
  }

  /// Drops corners that lie between their neighbours and stand out from them by less than `flat` m: points
  /// along a side, but for rounding.
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

  /// Adds the hull, an even sample of one with too many corners, but for what lies on a point that is there.
  void take(std::span<const SurfaceContact> points, double scale, Patch& patch,
            FixedArray<Index, Patch::capacity>& source) const {
    const std::size_t room = std::size_t(Patch::capacity - 1 - patch.count);
    const std::size_t count = std::min(hull_.size(), room);
    for (std::size_t k = 0; k < count; ++k) {
      const Index i = hull_[k * hull_.size() / count];
      bool is_twin = false;
      for (int j = 0; j < patch.count; ++j)
        is_twin = is_twin || squared_norm(patch.point[j].a - points[i].point.a) < 1e-6 * scale * scale;
      if (is_twin) continue;
      source[patch.count] = i;
      patch.add(points[i].point);
    }
  }
  /// The deepest point, where it is missed.
  static void add_deepest(std::span<const SurfaceContact> points, Index deepest, double scale, Patch& patch,
                          FixedArray<Index, Patch::capacity>& source) {
    for (int j = 0; j < patch.count; ++j)
      if (patch.point[j].gap <= points[deepest].point.gap + 5e-5 * scale) return;
    source[patch.count] = deepest;
    patch.add(points[deepest].point);
  }

  Array<Place> place_;
  Array<Index> order_, hull_;
};

}  // namespace delassus::inner
