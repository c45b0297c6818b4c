/// Where a sparse factorization of square blocks has entries: the order of elimination, and the fill.
#pragma once

#include <delassus/core/array.hpp>
#include <delassus/core/index.hpp>

#include <algorithm>
#include <functional>
#include <iterator>
#include <span>
#include <utility>
#include <vector>

namespace delassus {

/// The lower triangle of P A Pᵀ with its fill, for an A whose pattern is symmetric: column j has the rows
/// `row(start(j)) … row(start(j + 1) − 1)`, ascending, below the diagonal. P is by minimum degree.
/// Buffers keep their capacity from one analysis to the next.
template <class Index>
class BasicBlockPattern {
 public:
  /// All diagonal blocks and the pairs (i, j), i ≠ j, in any order, repeats allowed.
  void analyse(Index blocks, std::span<const std::pair<Index, Index>> pairs) {
    order(blocks, pairs);
    clear(blocks);
    for (auto [i, j] : pairs) {
      const auto [column, row] = std::minmax(place_[i], place_[j]);
      lists_[column].push_back(row);
    }
    start_.assign(1, 0);
    row_.clear();
    for (Index j = 0; j < blocks; ++j) {
      auto& rows = lists_[j];
      sort_unique(rows);
      // Fill: the rows below the first one of a column appear in that first row's column too.
      if (!rows.empty()) lists_[rows[0]].append(rows.begin() + 1, rows.end());
      row_.append(rows.begin(), rows.end());
      start_.push_back(Index(row_.size()));
    }
  }

  Index blocks() const { return Index(place_.size()); }
  Index entries() const { return Index(row_.size()); }
  /// The place of block b in the order of elimination.
  Index place(Index b) const { return place_[b]; }
  Index start(Index column) const { return start_[column]; }
  Index row(Index entry) const { return row_[entry]; }

  /// The entry of a row in a column; both are places, row > column, and the entry exists.
  Index find(Index row, Index column) const {
    const auto first = row_.begin() + start_[column], last = row_.begin() + start_[column + 1];
    return Index(std::lower_bound(first, last, row) - row_.begin());
  }

 private:
  using Degree = std::pair<Index, Index>;  ///< (degree, block)

  /// Minimum degree: the block with the fewest neighbours goes next, and its neighbours become neighbours of
  /// each other. Ties go to the lowest number. Plain lists; its cost is that of the fill.
  void order(Index blocks, std::span<const std::pair<Index, Index>> pairs) {
    clear(blocks);
    for (auto [i, j] : pairs) {
      lists_[i].push_back(j);
      lists_[j].push_back(i);
    }
    queue_.clear();
    for (Index b = 0; b < blocks; ++b) {
      sort_unique(lists_[b]);
      push(b);
    }
    place_.assign(blocks, -1);
    for (Index k = 0; k < blocks; ++k) {
      const Index b = pop();
      place_[b] = k;
      for (const Index n : lists_[b]) {
        merged_.clear();
        std::set_union(lists_[n].begin(), lists_[n].end(), lists_[b].begin(), lists_[b].end(),
                       std::back_inserter(merged_));
        erase_if(merged_, [&](Index i) { return i == n || i == b; });
        lists_[n].assign(merged_.begin(), merged_.end());
        push(n);
      }
    }
  }

  void push(Index b) {
    queue_.emplace_back(Index(lists_[b].size()), b);
    std::push_heap(queue_.begin(), queue_.end(), std::greater<Degree>{});
  }
  /// An entry that says a degree its block no longer has is passed over: a newer one is in the heap.
  Index pop() {
    for (;;) {
      const auto [degree, b] = queue_.front();
      std::pop_heap(queue_.begin(), queue_.end(), std::greater<Degree>{});
      queue_.pop_back();
      if (place_[b] < 0 && degree == Index(lists_[b].size())) return b;
    }
  }

  void clear(Index blocks) {
    if (Index(lists_.size()) < blocks) lists_.resize(blocks);
    for (auto& list : lists_) list.clear();
  }
  static void sort_unique(Array<Index>& list) {
    std::sort(list.begin(), list.end());
    list.erase(std::unique(list.begin(), list.end()), list.end());
  }

  Array<Index> place_, start_, row_, merged_;
  std::vector<Array<Index>> lists_;
  Array<Degree> queue_;
};

using BlockPattern = BasicBlockPattern<Index>;

}  // namespace delassus
