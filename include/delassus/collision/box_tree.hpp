/// Broad phase by two trees of fattened boxes and a list of pairs that is kept from step to step.
#pragma once

#include <delassus/collision/broad_phase.hpp>
#include <delassus/collision/inner/dynamic_tree.hpp>
#include <delassus/core/array.hpp>
#include <delassus/core/ranges.hpp>
#include <delassus/core/slice.hpp>
#include <delassus/core/sort.hpp>

#include <algorithm>
#include <cstdint>
#include <limits>

namespace delassus {

/// Each box has a leaf that is a little larger, and longer where it is heading: only when the box leaves its
/// leaf are its pairs looked up anew. So what rests costs one look at its box and one at each of its pairs.
/// Boxes that do not move are in a tree of their own and are no pairs of each other. Pairs come sorted; they
/// are those of the boxes themselves, whatever the leaves.
template <class Scalar>
class BasicBoxTree {
 public:
  Scalar margin =
      0.05;         ///< a leaf is wider than its box by this share of the box's largest edge, on each side
  Scalar lead = 4;  ///< and longer by this many steps of its last motion

  /// Boxes that are told apart by their place in the array, all of them moving. `Pairs`: a std::vector, or an Array.
  template <class Pairs>
  void find(inner::Slice<const Aabb> boxes, Pairs& pairs) {
    places_.resize(boxes.size());
    for (Index i = 0; i < Index(boxes.size()); ++i)
      places_[i] = {.key = std::uint32_t(i), .is_movable = true};
    find(boxes, places_, pairs);
  }

  /// Boxes that are told apart by their keys, wherever they stand in the array.
  template <class Pairs>
  void find(inner::Slice<const Aabb> boxes, inner::Slice<const BoxTag> tags, Pairs& pairs) {
    recognise(tags);
    moved_.clear();
    for (Index i = 0; i < Index(boxes.size()); ++i) follow(leaf_of_[i], boxes[i], tags[i].is_movable);
    for (Tree& tree : trees_) tree.balance();
    if (!moved_.empty()) renew_pairs();
    report(boxes, pairs);
  }
  /// The same by several workers, with the room that they have for it: `SharedSearch`. Pre: `pairs` is empty.
  void find(inner::Slice<const Aabb> boxes, inner::Slice<const BoxTag> tags, Array<CandidatePair>& pairs,
            const auto& by) {
    recognise(tags);
    moved_.clear();
    by.room.found.clear();
    by.room.places.fill(by.room.found, Index(boxes.size()), 256, by.execution,
                        [&](inner::Range range, Array<Index>& left) {
                          for (Index i = range.first; i < range.last; ++i)
                            if (!stays(leaf_[leaf_of_[i]], boxes[i], tags[i].is_movable)) left.push_back(i);
                        });
    for (const Index i : by.room.found) follow(leaf_of_[i], boxes[i], tags[i].is_movable);
    for (Tree& tree : trees_) tree.balance();
    if (!moved_.empty()) renew_pairs_in_parts(by);
    by.room.candidates.fill(pairs, Index(kept_.size()), 1024, by.execution,
                            [&](inner::Range range, Array<CandidatePair>& list) {
                              for (Index k = range.first; k < range.last; ++k)
                                if (const CandidatePair found = places_of(kept_[std::size_t(k)]);
                                    boxes[found.i].intersects(boxes[found.j]))
                                  list.push_back(found);
                            });
    if (!inner::is_sorted(pairs.data(), pairs.data() + pairs.size()))
      inner::sort(pairs.data(), pairs.data() + pairs.size());
  }

 private:
  using Tree = inner::BasicDynamicTree<Scalar>;
  struct Leaf {
    std::uint32_t key = 0;
    bool is_movable = true, has_moved = false;
    Index node = -1;             ///< in its tree; −1 while its box is empty
    Aabb box;                    ///< the fattened one
    Vec3 middle = zero<Vec3>();  ///< of the box itself, last step
  };

  /// Which leaf each box has. Usually the boxes stand as they stood; else the leaves are found by their keys.
  void recognise(inner::Slice<const BoxTag> tags) {
    bool is_same = tags.size() == leaf_of_.size();
    for (std::size_t i = 0; is_same && i < tags.size(); ++i) is_same = leaf_[leaf_of_[i]].key == tags[i].key;
    if (is_same) return;
    place_of_.assign(leaf_.size(), -1);
    leaf_of_.resize(tags.size());
    const auto by_key = [&](Index l, std::uint32_t key) { return leaf_[l].key < key; };
    const Index known = Index(sorted_.size());
    for (Index i = 0; i < Index(tags.size()); ++i) {
      const auto end = sorted_.begin() + known,
                 at = inner::lower_bound(sorted_.begin(), end, tags[i].key, by_key);
      if (at != end && leaf_[*at].key == tags[i].key) {
        leaf_of_[i] = *at;
      } else {
        leaf_of_[i] = take_leaf(tags[i].key);
        sorted_.push_back(leaf_of_[i]);
      }
      place_of_[leaf_of_[i]] = i;
    }
    moved_.clear();
    std::size_t kept = 0;
    for (const Index l : sorted_) {
      if (place_of_[l] >= 0) {
        sorted_[kept++] = l;
        continue;
      }
      leave(leaf_[l]);
      free_.push_back(l);
    }
    sorted_.resize(kept);
    if (!moved_.empty()) renew_pairs();
    inner::sort(sorted_, [&](Index x, Index y) { return leaf_[x].key < leaf_[y].key; });
  }

  Index take_leaf(std::uint32_t key) {
    if (free_.empty()) {
      leaf_.emplace_back();
      place_of_.push_back(-1);
      free_.push_back(Index(leaf_.size()) - 1);
    }
    const Index l = free_.back();
    free_.pop_back();
    leaf_[l] = Leaf{};
    leaf_[l].key = key;
    return l;
  }

  Tree& tree_of(const Leaf& leaf) { return trees_[leaf.is_movable ? 1 : 0]; }

  void leave(Leaf& leaf) {
    if (leaf.node < 0) return;
    tree_of(leaf).erase(leaf.node);
    leaf.node = -1;
    mark(leaf);
  }
  void mark(Leaf& leaf) {
    leaf.has_moved = true;
    moved_.push_back(Index(&leaf - leaf_.data()));
  }

  /// Puts the box of a leaf where it is now.
  void follow(Index l, const Aabb& box, bool is_movable) {
    Leaf& leaf = leaf_[l];
    if (box.is_empty() || leaf.is_movable != is_movable) leave(leaf);
    leaf.is_movable = is_movable;
    if (box.is_empty()) return;
    const Vec3 middle = (box.min() + box.max()) / 2;
    const Vec3 motion = leaf.node >= 0 ? Vec3(middle - leaf.middle) : zero<Vec3>();
    leaf.middle = middle;
    const double edge = max_entry(Vec3(box.max() - box.min()));
    if (leaf.node >= 0 && leaf.box.contains(box) && !is_slack(leaf.box, box, edge)) return;
    leaf.box = fattened(box, margin * edge, lead * motion, 2 * edge);
    if (leaf.node >= 0)
      tree_of(leaf).move(leaf.node, leaf.box);
    else
      leaf.node = tree_of(leaf).insert(leaf.box, l);
    if (!leaf.has_moved) mark(leaf);
  }

  /// Whether `follow` would leave its leaf where it is; then its middle is known.
  bool stays(Leaf& leaf, const Aabb& box, bool is_movable) const {
    if (box.is_empty() || leaf.is_movable != is_movable || leaf.node < 0) return false;
    if (!leaf.box.contains(box) || is_slack(leaf.box, box, max_entry(Vec3(box.max() - box.min())))) return false;
    leaf.middle = (box.min() + box.max()) / 2;
    return true;
  }

  /// True when the leaf is far larger than its box has use for: the box was fast, or has shrunk.
  bool is_slack(const Aabb& leaf, const Aabb& box, double edge) const {
    const Vec3 spare = (leaf.max() - leaf.min()) - (box.max() - box.min());
    return max_entry(spare) > (6 * margin + 1) * edge;
  }

  static Aabb fattened(const Aabb& box, double more, const Vec3& ahead, double limit) {
    Vec3 low = box.min(), high = box.max();
    for (int k = 0; k < 3; ++k) {
      low[k] += std::max(std::min(ahead[k], 0.0), -limit) - more;
      high[k] += std::min(std::max(ahead[k], 0.0), limit) + more;
    }
    return Aabb(low, high);
  }

  /// Drops the pairs of the leaves that moved and looks them up again. Two that both moved are found by the
  /// lower one.
  void renew_pairs() {
    erase_if(kept_, [&](std::uint64_t pair) { return has_moved(pair); });
    fresh_.clear();
    for (const Index l : moved_) {
      const Leaf& leaf = leaf_[l];
      if (leaf.node < 0) continue;
      const auto meets = [&](const Aabb& box) { return box.intersects(leaf.box); };
      const auto add = [&](Index other) { add_pair(l, other, fresh_); };
      trees_[1].visit(meets, add);
      if (leaf.is_movable) trees_[0].visit(meets, add);
    }
    for (const Index l : moved_) leaf_[l].has_moved = false;
    moved_.clear();
    inner::sort(fresh_);
    merged_.clear();
    std::size_t next = 0;
    for (const std::uint64_t pair : kept_) {
      for (; next < fresh_.size() && fresh_[next] < pair; ++next) merged_.push_back(fresh_[next]);
      merged_.push_back(pair);
    }
    for (; next < fresh_.size(); ++next) merged_.push_back(fresh_[next]);
    kept_.swap(merged_);
  }

  bool has_moved(std::uint64_t pair) const {
    return leaf_[Index(pair >> 32)].has_moved || leaf_[Index(pair & 0xffffffffu)].has_moved;
  }
  /// Of leaf l, which moved, and another one.
  [[gnu::always_inline]] void add_pair(Index l, Index other, Array<std::uint64_t>& to) const {
    if (other == l || (leaf_[other].has_moved && other < l)) return;
    to.push_back(std::uint64_t(std::min(l, other)) << 32 | std::uint64_t(std::max(l, other)));
  }
  /// `renew_pairs` by several workers: each looks up some leaves, and then each drops and merges some pairs.
  void renew_pairs_in_parts(const auto& by) {
    fresh_.clear();
    by.room.names.fill(fresh_, Index(moved_.size()), 16, by.execution,
                       [&](inner::Range range, Array<std::uint64_t>& list) {
                         for (Index k = range.first; k < range.last; ++k) {
                           const Index l = moved_[std::size_t(k)];
                           const Leaf& leaf = leaf_[l];
                           if (leaf.node < 0) continue;
                           const auto meets = [&](const Aabb& box) { return box.intersects(leaf.box); };
                           const auto add = [&](Index other) { add_pair(l, other, list); };
                           trees_[1].visit_at_once(meets, add);
                           if (leaf.is_movable) trees_[0].visit_at_once(meets, add);
                         }
                       });
    inner::sort(fresh_);
    merged_.clear();
    const Index count = Index(kept_.size());
    by.room.names.fill(merged_, count, 1024, by.execution, [&](inner::Range range, Array<std::uint64_t>& list) {
      const std::uint64_t *next = fresh_.data(), *end = next + fresh_.size();
      const auto before = [](std::uint64_t x, std::uint64_t y) { return x < y; };
      const std::uint64_t* const from = kept_.data();
      if (range.first > 0) next = inner::lower_bound(next, end, from[range.first], before);
      if (range.last < count) end = inner::lower_bound(next, end, from[range.last], before);
      for (Index k = range.first; k < range.last; ++k) {
        for (; next != end && *next < from[k]; ++next) list.push_back(*next);
        if (!has_moved(from[k])) list.push_back(from[k]);
      }
      for (; next != end; ++next) list.push_back(*next);
    });
    kept_.swap(merged_);
    for (const Index l : moved_) leaf_[l].has_moved = false;
    moved_.clear();
  }

  /// Where the boxes of two leaves stand now, the lower place first.
  CandidatePair places_of(std::uint64_t pair) const {
    const Index i = place_of_[Index(pair >> 32)], j = place_of_[Index(pair & 0xffffffffu)];
    return {std::min(i, j), std::max(i, j)};
  }

  template <class Pairs>
  void report(inner::Slice<const Aabb> boxes, Pairs& pairs) const {
    const std::size_t first = pairs.size();
    bool is_sorted = true;
    std::uint64_t last = 0;
    for (const std::uint64_t pair : kept_) {
      const Index i = place_of_[Index(pair >> 32)], j = place_of_[Index(pair & 0xffffffffu)];
      if (!boxes[i].intersects(boxes[j])) continue;
      const CandidatePair found{std::min(i, j), std::max(i, j)};
      const std::uint64_t name = std::uint64_t(found.i) << 32 | std::uint64_t(found.j);
      is_sorted = is_sorted && last < name;  // no pair is 0 and 0
      last = name;
      pairs.push_back(found);
    }
    if (!is_sorted) inner::sort(pairs.data() + first, pairs.data() + pairs.size());
  }

  Array<Leaf> leaf_;
  Array<Index> leaf_of_, sorted_, free_, moved_;
  Array<Index> place_of_;  ///< of each leaf in this call's array; −1 when it is not there
  Array<std::uint64_t> kept_, fresh_, merged_;
  Array<BoxTag> places_;
  Tree trees_[2];  ///< of what does not move, of what does
};

/// Fattens by doubles: the one that backends have.
using BoxTree = BasicBoxTree<double>;
}  // namespace delassus
