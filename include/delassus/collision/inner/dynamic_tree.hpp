/// A binary tree of boxes whose leaves come, go and grow.
#pragma once

#include <delassus/core/array.hpp>
#include <delassus/core/fixed_array.hpp>
#include <delassus/core/index.hpp>
#include <delassus/core/sort.hpp>
#include <delassus/geometry/support.hpp>

#include <algorithm>

namespace delassus::inner {

/// Half the surface of a box, m²: what it costs to have a node of this size.
inline double half_surface(const Aabb& box) {
  const Vec3 s = box.max() - box.min();
  return s[0] * s[1] + s[1] * s[2] + s[2] * s[0];
}

/// The box around two that are not empty.
inline Aabb around(const Aabb& a, const Aabb& b) {
  Aabb both = a;
  return both.extend(b);
}

inline bool is_same(const Aabb& a, const Aabb& b) {
  bool same = true;
  for (int k = 0; k < 3; ++k) same = same && a.min()[k] == b.min()[k] && a.max()[k] == b.max()[k];
  return same;
}

/// Each leaf carries a number. A leaf that moves keeps its place, and the boxes above it follow; when their
/// surfaces have grown by half in sum, the tree is built anew by medians. A visit to k hits among n leaves is
/// O(k + log n).
template <class Scalar>
class BasicDynamicTree {
 public:
  /// Adds a leaf where the boxes above it grow least, and returns its node.
  Index insert(const Aabb& box, Index item) {
    const Index leaf = take_node({.box = box, .item = item});
    ++leaf_count_;
    if (root_ < 0) {
      root_ = leaf;
      return leaf;
    }
    Index sibling = root_;
    while (!is_leaf(sibling)) {
      const auto growth = [&](Index n) {
        return half_surface(around(node_[n].box, box)) - (is_leaf(n) ? 0.0 : half_surface(node_[n].box));
      };
      const Index left = node_[sibling].child[0], right = node_[sibling].child[1];
      sibling = growth(left) <= growth(right) ? left : right;
    }
    const Index above = node_[sibling].parent;
    const Index parent = take_node({.box = node_[sibling].box, .parent = above, .child = {sibling, leaf}});
    replace_child(above, sibling, parent);
    node_[sibling].parent = node_[leaf].parent = parent;
    surface_ += half_surface(node_[parent].box);
    refit(parent);
    return leaf;
  }

  void erase(Index leaf) {
    const Index parent = node_[leaf].parent;
    --leaf_count_;
    release(leaf);
    if (parent < 0) {
      root_ = -1;
      return;
    }
    const Index left = node_[parent].child[0], right = node_[parent].child[1];
    const Index sibling = left == leaf ? right : left, above = node_[parent].parent;
    surface_ -= half_surface(node_[parent].box);
    node_[sibling].parent = above;
    replace_child(above, parent, sibling);
    release(parent);
    refit(above);
  }

  void move(Index leaf, const Aabb& box) {
    node_[leaf].box = box;
    refit(node_[leaf].parent);
  }

  /// To be called after a batch of changes. Nodes of leaves keep their numbers.
  void balance() {
    if (leaf_count_ < 3 || surface_ <= 1.5 * surface_when_built_) return;
    leaves_.clear();
    for (Index n = 0; n < Index(node_.size()); ++n)
      if (node_[n].is_used && is_leaf(n)) leaves_.push_back(n);
    for (Index n = 0; n < Index(node_.size()); ++n)
      if (node_[n].is_used && !is_leaf(n)) release(n);
    surface_ = 0;
    root_ = build(0, leaf_count_, -1);
    surface_when_built_ = surface_;
  }

  /// Calls visit(item) for every leaf whose box passes `meets(box)`, which must also hold for every box
  /// around it.
  template <class Meets, class Visit>
  void visit(const Meets& meets, const Visit& visit) const {
    if (root_ < 0) return;
    stack_.clear();
    stack_.push_back(root_);
    while (!stack_.empty()) {
      const Node& n = node_[stack_.back()];
      stack_.pop_back();
      if (!meets(n.box)) continue;
      if (n.item >= 0) {
        visit(n.item);
        continue;
      }
      stack_.push_back(n.child[1]);
      stack_.push_back(n.child[0]);
    }
  }
  /// The same in the same order, from several threads at once: it keeps no stack, and goes back by the parents.
  template <class Meets, class Visit>
  void visit_at_once(const Meets& meets, const Visit& visit) const {
    Index n = root_;
    while (n >= 0) {
      const Node& node = node_[n];
      if (meets(node.box)) {
        if (node.item < 0) {
          n = node.child[0];
          continue;
        }
        visit(node.item);
      }
      Index above = node.parent;
      while (above >= 0 && node_[above].child[1] == n) n = above, above = node_[n].parent;
      n = above >= 0 ? node_[above].child[1] : -1;
    }
  }

 private:
  struct Node {
    Aabb box;
    Index parent = -1;
    FixedArray<Index, 2> child{-1, -1};
    Index item = -1;  ///< ≥ 0 in a leaf
    bool is_used = true;
  };

  bool is_leaf(Index n) const { return node_[n].item >= 0; }

  Index take_node(const Node& node) {
    if (free_.empty()) {
      node_.push_back(node);
      return Index(node_.size()) - 1;
    }
    const Index n = free_.back();
    free_.pop_back();
    node_[n] = node;
    return n;
  }
  void release(Index n) {
    node_[n].is_used = false;
    free_.push_back(n);
  }
  void replace_child(Index parent, Index old, Index fresh) {
    if (parent < 0)
      root_ = fresh;
    else
      node_[parent].child[node_[parent].child[0] == old ? 0 : 1] = fresh;
  }

  /// Fits the boxes from n upwards to their children, as far as anything changes.
  void refit(Index n) {
    for (; n >= 0; n = node_[n].parent) {
      Aabb& box = node_[n].box;
      const Aabb fitted = around(node_[node_[n].child[0]].box, node_[node_[n].child[1]].box);
      if (is_same(fitted, box)) return;
      surface_ += half_surface(fitted) - half_surface(box);
      box = fitted;
    }
  }

  /// The subtree over leaves_[first, last), halved across the axis along which their centres spread most.
  Index build(Index first, Index last, Index parent) {
    if (last - first == 1) {
      node_[leaves_[first]].parent = parent;
      return leaves_[first];
    }
    const auto centre_of = [&](const Aabb& box) { return Aabb(Vec3(box.min() + box.max())); };
    Aabb whole = node_[leaves_[first]].box, centres = centre_of(whole);
    for (Index i = first + 1; i < last; ++i) {
      const Aabb& box = node_[leaves_[i]].box;
      centres = around(centres, centre_of(box));
      whole = around(whole, box);
    }
    const int axis = largest_entry(Vec3(centres.max() - centres.min()));
    const Index middle = (first + last) / 2;
    const auto centre = [&](Index leaf) { return node_[leaf].box.min()[axis] + node_[leaf].box.max()[axis]; };
    inner::select(leaves_.data() + first, leaves_.data() + middle, leaves_.data() + last,
                     [&](Index x, Index y) { return centre(x) < centre(y); });
    const Index n = take_node({.box = whole, .parent = parent});
    surface_ += half_surface(whole);
    const Index left = build(first, middle, n), right = build(middle, last, n);
    node_[n].child = {left, right};
    return n;
  }

  Array<Node> node_;
  Array<Index> free_, leaves_;
  mutable Array<Index> stack_;
  Index root_ = -1, leaf_count_ = 0;
  Scalar surface_ = 0, surface_when_built_ = 0;
};

using DynamicTree = BasicDynamicTree<double>;

}  // namespace delassus::inner
