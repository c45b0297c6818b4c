/// Items of an island by colour: those of one colour do not meet in W.
#pragma once

#include <delassus/core/array.hpp>
#include <delassus/core/index.hpp>
#include <delassus/solvers/law_table.hpp>

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <utility>

namespace delassus::inner {

/// So many items of a colour one thread sweeps at a time: some microseconds.
inline constexpr Index items_of_piece = 64;

/// W between the items of the pool; null where they do not meet.
template <class T>
const BlockRowsView<T>* own_blocks(const PoolView<T>& pool) {
  for (int b = 0; b < pool.block_rows; ++b)
    if (pool.blocks[b].lambda == pool.lambda) return pool.blocks + b;
  return nullptr;
}

/// Each span of a pool becomes a span for each colour, pool by pool. Greedy: each item in order takes the
/// first colour that none of its neighbours in the pool has, so that it depends on the island alone. Up to 64
/// colours; what finds none stands alone.
template <class T>
class Colouring {
 public:
  /// False where W has no blocks to colour by.
  bool make(const Span<T>* first, const Span<T>* last) {
    spans_.clear();
    items_.clear();
    std::size_t count = 0;
    for (const Span<T>* span = first; span != last; ++span) {
      if (!span->pool->is_matrix()) return false;
      count += std::size_t(span->count);
    }
    items_.reserve(count);
    for (const Span<T>* span = first; span != last; ++span) add(*span);
    return true;
  }
  /// Of each pool one after the other, and their items too.
  Array<Span<T>>& spans() { return spans_; }

 private:
  static constexpr int most = 64;

  void add(const Span<T>& span) {
    const BlockRowsView<T>* const own = own_blocks(*span.pool);
    colour_.resize(std::size_t(span.pool->items), none);
    std::size_t counts[most + 1] = {};
    for (const Index i : span) {
      std::uint64_t taken = 0;
      if (own)
        for (Index e = own->start[i]; e < own->start[i + 1]; ++e)
          if (const std::uint8_t c = colour_[std::size_t(own->column[e])]; c < most)
            taken |= std::uint64_t(1) << c;
      const int colour = ~taken == 0 ? most : __builtin_ctzll(~taken);
      colour_[std::size_t(i)] = std::uint8_t(colour);
      ++counts[colour];
    }
    sort(span, counts);
  }

  /// By colour, ascending but for the order inside a piece.
  void sort(const Span<T>& span, std::size_t* counts) {
    const std::size_t first = items_.size();
    items_.resize(first + std::size_t(span.count));
    std::size_t next[most + 1], at = first;
    for (int c = 0; c <= most; ++c) {
      next[c] = at;
      for (std::size_t k = 0; c == most && k < counts[c]; ++k)
        spans_.push_back({span.pool, items_.data() + at + k, 1});
      if (c < most && counts[c] > 0) spans_.push_back({span.pool, items_.data() + at, Index(counts[c])});
      at += counts[c];
    }
    for (const Index i : span) items_[next[colour_[std::size_t(i)]]++] = i;
    for (const Index i : span) colour_[std::size_t(i)] = none;
    at = first;
    for (int c = 0; c < most; at += counts[c], ++c) {
      Index* const items = items_.data() + at;
      const Index count = Index(counts[c]);
      for (Index k = 0; k < count; k += items_of_piece)
        sort_by_neighbours(span, items + k, std::min(count - k, items_of_piece));
      if (count > 2 && items[count - 1] - items[0] == count - 1) std::swap(items[0], items[1]);  // see `Span`
    }
  }
  /// Those with many neighbours first: lanes sweep some that follow each other in the time of the slowest.
  static void sort_by_neighbours(const Span<T>& span, Index* items, Index count) {
    const BlockRowsView<T>* const own = own_blocks(*span.pool);
    if (!own) return;
    // By counting; whose neighbours are more than are counted share the first place, and then go by insertion.
    constexpr Index counted = 32;
    const auto neighbours = [own](Index i) { return own->start[i + 1] - own->start[i]; };
    Index next[counted + 1] = {}, sorted[items_of_piece];
    for (Index k = 0; k < count; ++k) ++next[std::min(neighbours(items[k]), counted)];
    for (Index n = counted, at = 0; n >= 0; --n) at += std::exchange(next[n], at);
    for (Index k = 0; k < count; ++k) sorted[next[std::min(neighbours(items[k]), counted)]++] = items[k];
    for (Index k = 0; k < count; ++k) items[k] = sorted[k];
    for (Index k = 1; k < next[counted]; ++k) {
      const Index i = items[k];
      Index to = k;
      for (; to > 0 && neighbours(items[to - 1]) < neighbours(i); --to) items[to] = items[to - 1];
      items[to] = i;
    }
  }

  static constexpr std::uint8_t none = 255;
  Array<Span<T>> spans_;
  Array<Index> items_;
  Array<std::uint8_t> colour_;  ///< by item of the pool; `none` between spans
};

}  // namespace delassus::inner
