/// A tree of boxes over items that keep their order: built once, fitted again as often as they move.
#pragma once

#include <delassus/core/index.hpp>
#include <delassus/core/sort.hpp>
#include <delassus/math/linear.hpp>

#include <algorithm>
#include <limits>
#include <span>
#include <vector>

namespace delassus::inner {

/// A box by its corners, m; empty at first.
struct Bounds {
  Vec3 low = Vec3::Constant(std::numeric_limits<double>::infinity());
  Vec3 high = Vec3::Constant(-std::numeric_limits<double>::infinity());

  void add(const Vec3& p) {
    for (int k = 0; k < 3; ++k) {
      low[k] = p[k] < low[k] ? p[k] : low[k];
      high[k] = p[k] > high[k] ? p[k] : high[k];
    }
  }
  void add(const Bounds& b) {
    add(b.low);
    add(b.high);
  }
  /// Wider by as much on each side.
  Bounds grown(double by) const {
    const Vec3 wide(by, by, by);
    return {low - wide, high + wide};
  }
  /// How far p is beyond it along each axis.
  Vec3 beyond(const Vec3& p) const {
    Vec3 out;
    for (int k = 0; k < 3; ++k) out[k] = std::max({low[k] - p[k], 0.0, p[k] - high[k]});
    return out;
  }
  bool meets(const Bounds& b) const {
    return low[0] <= b.high[0] && high[0] >= b.low[0] && low[1] <= b.high[1] && high[1] >= b.low[1] &&
           low[2] <= b.high[2] && high[2] >= b.low[2];
  }
};

/// Nodes stand parent before child and left before right, so that one pass backwards fits them all and a
/// visit needs no stack: a node that is not met is skipped with all below it. Leaves hold up to four items.
class FlatTree {
 public:
  static constexpr Index leaf_size = 4;

  /// bounds_of(item) gives the Bounds of an item in [0, count).
  template <class BoundsOf>
  void build(Index count, const BoundsOf& bounds_of) {
    item_.resize(std::size_t(count));
    std::vector<Vec3> centre(std::size_t(count), zero<Vec3>());
    for (Index i = 0; i < count; ++i) {
      const Bounds b = bounds_of(i);
      item_[i] = i;
      centre[i] = b.low + b.high;
    }
    node_.clear();
    if (count > 0) split(0, count, centre);
    fit(bounds_of);
  }

  /// Fits all boxes to the items as they are now.
  template <class BoundsOf>
  void fit(const BoundsOf& bounds_of) {
    for (Index n = Index(node_.size()) - 1; n >= 0; --n) {
      Node& node = node_[n];
      node.box = {};
      if (node.count > 0) {
        for (Index i = node.first; i < node.first + node.count; ++i) node.box.add(bounds_of(item_[i]));
      } else {
        node.box.add(node_[n + 1].box);
        node.box.add(node_[node_[n + 1].skip].box);
      }
    }
  }

  Bounds bounds() const { return node_.empty() ? Bounds{} : node_[0].box; }

  /// Calls visit(item) for the items of every leaf whose box passes `meets(bounds)`, which must hold for
  /// every box around it too.
  template <class Meets, class Visit>
  void visit(const Meets& meets, const Visit& visit) const {
    for (Index n = 0; n < Index(node_.size());) {
      const Node& node = node_[n];
      if (!meets(node.box)) {
        n = node.skip;
        continue;
      }
      for (Index i = node.first; i < node.first + node.count; ++i) visit(item_[i]);
      ++n;
    }
  }

  /// Descends two trees together: calls visit(items, other_items), spans of up to `leaf_size`, for every two
  /// leaves whose boxes pass `meets(box, other_box)`, which must hold for all boxes around them too.
  template <class Meets, class Visit>
  static void cross(const FlatTree& a, const FlatTree& b, const Meets& meets, const Visit& visit) {
    if (!a.node_.empty() && !b.node_.empty()) cross_from(a, 0, b, 0, meets, visit);
  }

  void memory(auto& archive) { archive(node_, item_); }

 private:
  struct Node {
    Bounds box;
    Index skip = 0;              ///< the node after all that are below this one
    Index first = 0, count = 0;  ///< items of a leaf; none above
  };

  /// The longer box is opened first; the depth is that of both trees.
  template <class Meets, class Visit>
  static void cross_from(const FlatTree& a, Index n, const FlatTree& b, Index m, const Meets& meets,
                         const Visit& visit) {
    const Node &x = a.node_[n], &y = b.node_[m];
    if (!meets(x.box, y.box)) return;
    if (x.count > 0 && y.count > 0) {
      visit(a.items(x), b.items(y));
    } else if (y.count > 0 || (x.count == 0 && length2(x.box) >= length2(y.box))) {
      cross_from(a, n + 1, b, m, meets, visit);
      cross_from(a, a.node_[n + 1].skip, b, m, meets, visit);
    } else {
      cross_from(a, n, b, m + 1, meets, visit);
      cross_from(a, n, b, b.node_[m + 1].skip, meets, visit);
    }
  }
  std::span<const Index> items(const Node& leaf) const {
    return std::span<const Index>(item_).subspan(std::size_t(leaf.first), std::size_t(leaf.count));
  }
  static double length2(const Bounds& b) { return squared_norm(b.high - b.low); }

  /// Halves the items across the axis along which their centres spread most.
  void split(Index first, Index last, const std::vector<Vec3>& centre) {
    const std::size_t n = node_.size();
    node_.emplace_back();
    if (last - first <= leaf_size) {
      node_[n].first = first, node_[n].count = last - first;
    } else {
      Bounds spread;
      for (Index i = first; i < last; ++i) spread.add(centre[item_[i]]);
      const int axis = largest_entry(Vec3(spread.high - spread.low));
      const Index middle = first + ((last - first) / 2 + 3) / 4 * 4;
      const auto is_before = [&](Index i, Index j) {
        return centre[i][axis] < centre[j][axis] || (centre[i][axis] == centre[j][axis] && i < j);
      };
      inner::select(item_.data() + first, item_.data() + middle, item_.data() + last, is_before);
      split(first, middle, centre);
      split(middle, last, centre);
    }
    node_[n].skip = Index(node_.size());
  }

  std::vector<Node> node_;
  std::vector<Index> item_;
};

}  // namespace delassus::inner
