/// Where a sparse factorization of square blocks has entries: the order of elimination, and the fill.
#pragma once

#include <delassus/core/array.hpp>
#include <delassus/core/index.hpp>
#include <delassus/core/owning_array.hpp>
#include <delassus/core/slice.hpp>
#include <delassus/core/sort.hpp>

#include <cstddef>
#include <cstdint>
#include <utility>

namespace delassus {

/// The lower triangle of P A Pᵀ with its fill, for an A whose pattern is symmetric: column j has the rows
/// `row(start(j)) … row(start(j + 1) − 1)`, ascending, below the diagonal. P is by minimum degree.
/// Buffers keep their capacity from one analysis to the next.
template <class Index>
class BasicBlockPattern {
 public:
  /// All diagonal blocks and the pairs (i, j), i ≠ j, in any order, repeats allowed.
  void analyse(Index blocks, inner::Slice<const std::pair<Index, Index>> pairs) {
    order(blocks, pairs);
    clear(blocks);
    for (const auto& pair : pairs) {
      const Index a = place_[pair.first], b = place_[pair.second];
      lists_[a < b ? a : b].push_back(a < b ? b : a);
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
    return Index(inner::lower_bound(first, last, row) - row_.begin());
  }

 private:
  /// A heap's largest is then its least.
  struct IsLarger {
    bool operator()(std::uint64_t a, std::uint64_t b) const { return a > b; }
  };

  /// Minimum degree: the block with the fewest neighbours goes next, and its neighbours become neighbours of
  /// each other. Ties go to the lowest number. Plain lists; its cost is that of the fill.
  void order(Index blocks, inner::Slice<const std::pair<Index, Index>> pairs) {
    clear(blocks);
    for (const auto& pair : pairs) {
      lists_[pair.first].push_back(pair.second);
      lists_[pair.second].push_back(pair.first);
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
        unite(lists_[n], lists_[b], n, b);
        lists_[n] = merged_;
        push(n);
      }
    }
  }

  /// What is in either of two ascending lists, but for n and b.
  void unite(const Array<Index>& x, const Array<Index>& y, Index n, Index b) {
    merged_.clear();
    for (std::size_t i = 0, j = 0; i < x.size() || j < y.size();) {
      const bool takes_x = j == y.size() || (i < x.size() && x[i] <= y[j]), takes_y = i == x.size() || (j < y.size() && y[j] <= x[i]);
      const Index next = takes_x ? x[i] : y[j];
      i += takes_x, j += takes_y;
      if (next != n && next != b) merged_.push_back(next);
    }
  }

  void push(Index b) {
    queue_.push_back(std::uint64_t(lists_[b].size()) << 32 | std::uint64_t(b));
    inner::push_on_heap(queue_.data(), queue_.size(), IsLarger{});
  }
  /// An entry that says a degree its block no longer has is passed over: a newer one is in the heap.
  Index pop() {
    for (;;) {
      const std::uint64_t least = queue_[0];
      inner::pop_from_heap(queue_.data(), queue_.size(), IsLarger{});
      queue_.pop_back();
      const Index b = Index(least & 0xffffffffu);
      if (place_[b] < 0 && least >> 32 == lists_[b].size()) return b;
    }
  }

  void clear(Index blocks) {
    if (Index(lists_.size()) < blocks) lists_.resize(blocks);
    for (auto& list : lists_) list.clear();
  }
  static void sort_unique(Array<Index>& list) {
    inner::sort(list);
    inner::drop_repeats(list);
  }

  Array<Index> place_, start_, row_, merged_;
  OwningArray<Array<Index>> lists_;
  Array<std::uint64_t> queue_;  ///< a degree and its block
};

using BlockPattern = BasicBlockPattern<Index>;

}  // namespace delassus
