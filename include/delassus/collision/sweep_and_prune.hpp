/// Sweep and prune: boxes sorted along one axis, each tested against those that begin before it ends.
#pragma once

#include <delassus/collision/broad_phase.hpp>
#include <delassus/core/array.hpp>
#include <delassus/core/slice.hpp>
#include <delassus/core/sort.hpp>

#include <algorithm>

namespace delassus {

/// Keeps last step's order, so that sorting by insertion is nearly free while things move little. The axis is
/// the one along which the centres of the boxes spread most.
class SweepAndPrune {
 public:
  /// Appends the pairs of places whose boxes intersect, the lower place first. An empty box is in none.
  void find(inner::Slice<const Aabb> boxes, std::vector<CandidatePair>& pairs) {
    const int axis = widest_axis(boxes);
    if (boxes.size() != order_.size() || axis != axis_) restart(boxes, axis);
    sort(boxes);
    for (std::size_t s = 0; s < order_.size(); ++s) {
      const Index i = order_[s];
      if (boxes[i].is_empty()) continue;
      const double end = boxes[i].max()[axis];
      for (std::size_t t = s + 1; t < order_.size() && start(boxes, order_[t]) <= end; ++t) {
        const Index j = order_[t];
        if (!boxes[j].is_empty() && boxes[i].intersects(boxes[j]))
          pairs.push_back({std::min(i, j), std::max(i, j)});
      }
    }
  }

 private:
  /// Where a box begins along the axis; an empty one begins at +∞.
  double start(inner::Slice<const Aabb> boxes, Index i) const { return boxes[i].min()[axis_]; }

  void sort(inner::Slice<const Aabb> boxes) {
    for (std::size_t s = 1; s < order_.size(); ++s) {
      const Index moving = order_[s];
      std::size_t t = s;
      for (; t > 0 && start(boxes, moving) < start(boxes, order_[t - 1]); --t) order_[t] = order_[t - 1];
      order_[t] = moving;
    }
  }

  void restart(inner::Slice<const Aabb> boxes, int axis) {
    axis_ = axis;
    order_.resize(boxes.size());
    for (Index i = 0; i < Index(boxes.size()); ++i) order_[i] = i;
    inner::sort(order_,
              [&](Index i, Index j) { return start(boxes, i) < start(boxes, j); });
  }

  /// Changes only when another axis spreads twice as much.
  int widest_axis(inner::Slice<const Aabb> boxes) const {
    Vec3 sum = zero<Vec3>(), low = zero<Vec3>();
    Vec3 squares = zero<Vec3>();
    Index count = 0;
    for (const Aabb& box : boxes) {
      if (box.is_empty()) continue;
      const Vec3 middle = (box.min() + box.max()) / 2;
      if (count++ == 0) low = middle;
      for (int k = 0; k < 3; ++k) {
        const double centre = middle[k] - low[k];
        sum[k] += centre;
        squares[k] += centre * centre;
      }
    }
    if (count == 0) return axis_;
    Vec3 variance;
    int widest = 0;
    for (int k = 0; k < 3; ++k) {
      variance[k] = squares[k] - sum[k] * sum[k] / double(count);
      if (variance[k] > variance[widest]) widest = k;
    }
    return variance[widest] > 2 * variance[axis_] ? widest : axis_;
  }

  Array<Index> order_;
  int axis_ = 0;
};
}  // namespace delassus
