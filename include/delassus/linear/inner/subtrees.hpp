/// Which parts of an elimination tree several workers take at once, and where their fronts leave what is for
/// their parents.
#pragma once

#include <delassus/core/array.hpp>
#include <delassus/core/index.hpp>
#include <delassus/core/sort.hpp>
#include <delassus/linear/supernodes.hpp>

#include <algorithm>
#include <cstddef>

namespace delassus::inner {

/// The fronts first … last, of which `last` is above all others, and what they cost.
struct Subtree {
  Index first, last;
  double work;

  /// The most work first.
  bool operator<(const Subtree& o) const { return work != o.work ? work > o.work : first < o.first; }
};

/// Subtrees with nothing in common, each one worker's, and the fronts above them. Of the cuts that open the
/// heaviest subtree again and again it is the one whose work is thought to be done first.
class Subtrees {
 public:
  /// `w`: numbers a node. Work is products; all workers share the fronts above.
  void analyse_factor(const SupernodalPattern& pattern, int w, Index workers) {
    analyse(pattern, workers, 0.8 * workers, [w](const Supernode& x) {
      const double width = w * double(x.width), below = w * double(x.below());
      return width * (width * width / 3 + below * (width + below));
    });
    place_parts(pattern, w);
  }
  /// Work is numbers of the factor; one worker has the fronts above.
  void analyse_solve(const SupernodalPattern& pattern, Index workers) {
    analyse(pattern, workers, 1,
            [](const Supernode& x) { return double(x.width) * (0.5 * double(x.width) + double(x.below())); });
  }

  Index count() const { return Index(trees_.size()); }
  /// By work, the most first.
  const Subtree& operator[](Index tree) const { return trees_[tree]; }
  /// Which one a front is in; −1: above all.
  Index tree_of(Index front) const { return tree_of_[front]; }
  /// Where a front's part for its parent begins.
  std::size_t part(Index front) const { return part_[front]; }
  std::size_t size_of_parts() const { return size_; }

 private:
  static Index first_of(const SupernodalPattern& pattern, Index front) {
    return pattern.supernode_of(pattern.supernodes()[front].first_descendant);
  }

  void analyse(const SupernodalPattern& pattern, Index workers, double above_at_once, const auto& cost) {
    const auto& fronts = pattern.supernodes();
    Array<double> work(fronts.size(), 0.);  // of whole subtrees
    Array<Subtree> trees;
    for (Index s = 0; s < Index(fronts.size()); ++s) {
      work[s] += cost(fronts[s]);
      if (fronts[s].parent >= 0)
        work[fronts[s].parent] += work[s];
      else
        trees.push_back({first_of(pattern, s), s, work[s]});
    }
    double above = 0, best = -1;
    for (;;) {
      inner::sort(trees);
      const double time = above / above_at_once + longest_share(trees, workers);
      if (best < 0 || time < best) best = time, trees_ = trees;
      if (trees.empty() || Index(trees.size()) > 8 * workers || fronts[trees[0].last].children.empty()) break;
      const Index top = trees[0].last;
      above += cost(fronts[top]);
      trees[0] = trees.back();
      trees.pop_back();
      for (const Index child : fronts[top].children)
        trees.push_back({first_of(pattern, child), child, work[child]});
    }
    tree_of_.assign(fronts.size(), -1);
    for (std::size_t t = 0; t < trees_.size(); ++t)
      for (Index s = trees_[t].first; s <= trees_[t].last; ++s) tree_of_[s] = Index(t);
  }
  /// Each takes the next subtree when it has done the last.
  static double longest_share(const Array<Subtree>& trees, Index workers) {
    Array<double> share(std::size_t(workers), 0.);
    for (const Subtree& tree : trees) *std::min_element(share.begin(), share.end()) += tree.work;
    return *std::max_element(share.begin(), share.end());
  }

  /// Two stacks for each subtree, and two for the fronts above, as in `FrontLayout`.
  void place_parts(const SupernodalPattern& pattern, int w) {
    const auto& fronts = pattern.supernodes();
    struct Stacks {
      std::size_t top[2] = {}, highest[2] = {}, begin = 0;
    };
    Array<Stacks> stacks(trees_.size() + 1, Stacks{});
    const auto stacks_of = [&](Index s) -> Stacks& { return stacks[std::size_t(tree_of_[s] + 1)]; };
    Array<char> depth(fronts.size(), 0);  // modulo 2
    for (Index s = Index(fronts.size()); s-- > 0;)
      if (fronts[s].parent >= 0) depth[s] = !depth[fronts[s].parent];
    part_.resize(fronts.size());
    for (Index s = 0; s < Index(fronts.size()); ++s) {
      const std::size_t below = std::size_t(w) * fronts[s].below();
      Stacks& own = stacks_of(s);
      for (const Index child : fronts[s].children)
        if (tree_of_[child] == tree_of_[s]) {
          own.top[!depth[s]] = part_[child];
          break;
        }
      std::size_t& end = own.top[int(depth[s])];
      part_[s] = end;
      end += below * below;
      for (const int k : {0, 1}) own.highest[k] = std::max(own.highest[k], own.top[k]);
    }
    size_ = 0;
    for (Stacks& own : stacks) {
      own.begin = size_;
      size_ += own.highest[0] + own.highest[1];
    }
    for (std::size_t s = 0; s < fronts.size(); ++s) {
      const Stacks& own = stacks_of(Index(s));
      part_[s] += own.begin + (depth[s] ? own.highest[0] : 0);
    }
  }

  Array<Subtree> trees_;
  Array<Index> tree_of_;
  Array<std::size_t> part_;
  std::size_t size_ = 0;
};

}  // namespace delassus::inner
