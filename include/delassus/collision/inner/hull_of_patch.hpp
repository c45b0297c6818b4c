/// Of many contact points with nearly one normal, those that carry: the outermost and the deepest.
#pragma once

#include <delassus/collision/inner/flat_hull.hpp>
#include <delassus/collision/manifold.hpp>
#include <delassus/core/array.hpp>
#include <delassus/core/fixed_array.hpp>

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
  /// within 1e-3 of the scale of the deepest, which is the area that touches, and of all of them when these are fewer than
  /// four, or not around the middle of all: then the other side has to be met too. Sides that are chords of `round` stand for its rim.
  void choose(std::span<const SurfaceContact> points, const Vec3& n, double scale, const RoundFace& round, Patch& patch,
              FixedArray<Index, Patch::capacity>& source) {
    flat_.project(Index(points.size()), [&](Index i) -> const Vec3& { return points[i].point.a; }, n);
    Index deepest = 0;
    for (Index i = 1; i < Index(points.size()); ++i)
      if (points[i].point.gap < points[deepest].point.gap) deepest = i;
    patch.clear();
    take(points, hull(points, points[deepest].point.gap + 1e-3 * scale, scale), scale, patch, source);
    patch.area = area_of_patch(patch, n, round);
    const int corners = patch.count;
    add_deepest(points, deepest, scale, patch, source);
    if (order_.size() == points.size()) return;
    const Array<Index>& all = hull(points, std::numeric_limits<double>::infinity(), scale);
    const Vec3 middle = area_of(int(all.size()), [&](int k) -> const Vec3& { return points[all[std::size_t(k)]].point.a; }, n).middle;
    if (patch.count >= 4 && is_around(patch, corners, middle, n)) return;
    take(points, all, scale, patch, source);
    add_deepest(points, deepest, scale, patch, source);
  }

 private:
  /// The hull of the points with a gap up to `most`, m.
  const Array<Index>& hull(std::span<const SurfaceContact> points, double most, double scale) {
    order_.clear();
    for (Index i = 0; i < Index(points.size()); ++i)
      if (points[i].point.gap <= most) order_.push_back(i);
    return flat_.find(order_, 1e-5 * scale);
  }
  /// Whether x lies inside the first points, counter-clockwise about n, seen along n.
  static bool is_around(const Patch& patch, int corners, const Vec3& x, const Vec3& n) {
    for (int k = 0; k < corners; ++k) {
      const Vec3 &p = patch.point[k].a, &q = patch.point[k + 1 < corners ? k + 1 : 0].a;
      if (dot(n, cross(q - p, x - p)) < 0) return false;
    }
    return true;
  }
  /// Adds the hull, an even sample of one with too many corners, but for what lies on a point that is there.
  static void take(std::span<const SurfaceContact> points, const Array<Index>& hull, double scale, Patch& patch,
                   FixedArray<Index, Patch::capacity>& source) {
    const std::size_t room = std::size_t(Patch::capacity - 1 - patch.count);
    const std::size_t count = std::min(hull.size(), room);
    for (std::size_t k = 0; k < count; ++k) {
      const Index i = hull[k * hull.size() / count];
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

  FlatHull flat_;
  Array<Index> order_;
};

}  // namespace delassus::inner
