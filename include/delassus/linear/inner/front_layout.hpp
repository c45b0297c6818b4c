/// Where the fronts of a multifrontal factorization keep their numbers, and where a child adds to its parent.
#pragma once

#include <delassus/core/array.hpp>
#include <delassus/linear/supernodes.hpp>

#include <algorithm>
#include <cstddef>
#include <vector>

namespace delassus::inner {

/// `length` rows of a child, in a run from its row `from`, are the rows of its parent from `to` on.
struct FrontRun {
  Index from, to, length;
};

/// Where a front's columns of L are, where its part for the parent is, and where that goes.
struct FrontPlace {
  std::size_t factor = 0, update = 0;
  Array<FrontRun> runs;
};

/// Columns of L lie one after the other. Parts for parents are on two stacks, as children stand before their
/// parents: those of even depth on one, those of odd depth on the other, so that a front takes its children's
/// from the top of one and leaves its own on top of the other. Sizes are in numbers.
template <class Index>
struct BasicFrontLayout {
  std::vector<FrontPlace> fronts;
  std::size_t factor_size = 0, stack_size = 0;
  Index most_rows = 0;  ///< of a front, in numbers

  /// `w`: numbers a node.
  void analyse(const SupernodalPattern& pattern, int w) {
    const auto& supernodes = pattern.supernodes();
    fronts.assign(supernodes.size(), {});
    factor_size = 0, most_rows = 0;
    Array<char> depth(fronts.size(), 0);  // modulo 2
    for (Index s = Index(fronts.size()); s-- > 0;)
      if (supernodes[s].parent >= 0) depth[s] = !depth[supernodes[s].parent];
    std::size_t top[2] = {}, highest[2] = {};
    for (Index s = 0; s < Index(fronts.size()); ++s) {
      const Supernode& x = supernodes[s];
      FrontPlace& front = fronts[s];
      const std::size_t below = std::size_t(w) * x.below();
      most_rows = std::max(most_rows, w * Index(x.rows.size()));
      front.factor = factor_size;
      factor_size += std::size_t(w) * x.rows.size() * w * x.width;
      if (!x.children.empty()) top[!depth[s]] = fronts[x.children[0]].update;
      std::size_t& end = top[int(depth[s])];
      front.update = end;
      end += below * below;
      for (const int k : {0, 1}) highest[k] = std::max(highest[k], top[k]);
      if (x.parent >= 0) find_runs(x, supernodes[x.parent], front.runs);
    }
    stack_size = highest[0] + highest[1];
    for (std::size_t s = 0; s < fronts.size(); ++s)
      if (depth[s]) fronts[s].update += highest[0];
  }

 private:
  static void find_runs(const Supernode& child, const Supernode& parent, Array<FrontRun>& runs) {
    for (Index k = 0, at = 0; k < child.below(); ++k, ++at) {
      while (parent.rows[at] != child.rows[child.width + k]) ++at;
      if (!runs.empty() && runs.back().to + runs.back().length == at)
        ++runs.back().length;
      else
        runs.push_back({k, at, 1});
    }
  }
};

using FrontLayout = BasicFrontLayout<Index>;

}  // namespace delassus::inner
