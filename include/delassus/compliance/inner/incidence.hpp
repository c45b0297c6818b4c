/// Which rows act on a block, and the columns A⁻¹ Hᵀ of a set whose blocks are coupled.
#pragma once

#include <delassus/core/array.hpp>
#include <delassus/core/owning_array.hpp>
#include <delassus/math/linear.hpp>
#include <delassus/rows/row_view.hpp>

#include <cstddef>
#include <span>

namespace delassus::inner {

/// For every set, pool and block that moves: the entries (item, entry) that act there, in the order of insertion. Through one that does
/// not, constraints of several islands would meet.
template <class T>
class Incidence {
 public:
  struct Entry {
    Index item, entry;
  };
  struct Entries {
    const Entry *first, *last;
    const Entry* begin() const { return first; }
    const Entry* end() const { return last; }
  };

  /// Lists set s of all pools; whether each of its blocks moves.
  void find(const RowView<T>* pools, int count, int s, const Array<char>& moves) {
    const Index blocks = Index(moves.size());
    pools_ = count;
    if (const std::size_t room = std::size_t((s + 1) * count); lists_.size() < room) lists_.resize(room);
    for (int p = 0; p < count; ++p) {
      const SetBlocksView<T>& set = pools[p].set[s];
      const Index entries = set.offset[pools[p].items];
      if (entries == 0) continue;  // nobody asks `at`
      List& list = lists_[std::size_t(s * count + p)];
      list.start.assign_zeros(std::size_t(blocks) + 1);
      Index* const start = list.start.data();
      const char* const moving = moves.data();
      for (Index e = 0; e < entries; ++e) {
        const Index block = set.block[e];
        start[block] += moving[block];
      }
      for (Index b = 0, sum = 0; b <= blocks; ++b) sum = start[b] += sum;
      list.entries.resize(std::size_t(start[blocks]));
      Entry* const to = list.entries.data();
      // From the ends of the blocks, and the last first: so they stand in order.
      for (Index i = pools[p].items; i-- > 0;)
        for (Index e = set.offset[i + 1], first = set.offset[i]; e-- > first;)
          if (const Index block = set.block[e]; moving[block]) to[--start[block]] = {i, e};
    }
  }

  /// Pre: pool p acts on set s.
  Entries at(int s, int p, Index block) const {
    const List& list = lists_[std::size_t(s * pools_ + p)];
    return {list.entries.data() + list.start[std::size_t(block)], list.entries.data() + list.start[std::size_t(block) + 1]};
  }

 private:
  struct List {
    Array<Index> start;
    Array<Entry> entries;
  };
  int pools_ = 0;
  OwningArray<List> lists_;
};

/// For a set whose A couples its blocks: whole columns A⁻¹ H_jᵀ, one solve a row.
template <class T>
class CoupledColumns {
 public:
  /// The columns of set s. Velocities of a set lie one block after the other.
  template <class Set>
  void prepare(const Set& set, const RowView<T>* pools, int count, int s) {
    constexpr int w = Set::width;
    count_ = count;
    blocks_ = std::size_t(set.blocks());
    if (const std::size_t room = std::size_t((s + 1) * count); lists_.size() < room) lists_.resize(room);
    x_.resize(blocks_ * std::size_t(w));
    const std::span<Vec<w, T>> x(reinterpret_cast<Vec<w, T>*>(x_.data()), blocks_);
    for (int p = 0; p < count; ++p) {
      const RowView<T>& mine = pools[p];
      const SetBlocksView<T>& H = mine.set[s];
      List& list = lists_[std::size_t(s * count + p)];
      list.items.clear();
      for (Index i = 0; i < mine.items; ++i)
        if (H.has_entries(i)) list.items.push_back(i);
      list.numbers.resize(list.items.size() * blocks_ * std::size_t(w * mine.rows));
      T* to = list.numbers.data();
      for (const Index i : list.items) {
        for (int k = 0; k < mine.rows; ++k) {
          for (auto& v : x) set_all(v, T(0));
          for (Index e = H.offset[i]; e < H.offset[i + 1]; ++e)
            for (int c = 0; c < w; ++c) x[std::size_t(H.block[e])][c] += H.H[std::ptrdiff_t(mine.rows * w) * e + k + mine.rows * c];
          set.solve(x);
          for (std::size_t b = 0; b < blocks_; ++b)
            for (int c = 0; c < w; ++c) to[b * std::size_t(w * mine.rows) + std::size_t(c + w * k)] = x[b][c];
        }
        to += blocks_ * std::size_t(w * mine.rows);
      }
    }
  }

  /// f(b, j, H, A⁻¹ H_jᵀ, w) for all items j of all pools b, H of the entries of item i of pool a in set s; not where the two
  /// act on bodies that A does not couple.
  template <class F>
  void each(const RowView<T>* pools, int s, int a, Index i, const F& f) const {
    const RowView<T>& mine = pools[a];
    const SetBlocksView<T>& H = mine.set[s];
    if (!H.has_entries(i)) return;
    const int w = H.width;
    for (int b = 0; b < count_; ++b) {
      const List& list = lists_[std::size_t(s * count_ + b)];
      const std::size_t size = std::size_t(w * pools[b].rows);
      for (std::size_t n = 0; n < list.items.size(); ++n)
        for (Index e = H.offset[i]; e < H.offset[i + 1]; ++e) {
          const T* response = list.numbers.data() + (n * blocks_ + std::size_t(H.block[e])) * size;
          bool answers = false;
          for (std::size_t k = 0; k < size; ++k) answers = answers || response[k] != T(0);
          if (answers) f(b, list.items[n], H.H + std::ptrdiff_t(mine.rows * w) * e, response, w);
        }
    }
  }

 private:
  struct List {
    Array<Index> items;
    Array<T> numbers;  ///< width × rows a block, block by block, item by item
  };
  int count_ = 0;
  std::size_t blocks_ = 0;
  Array<T> x_;  ///< velocities of the set
  OwningArray<List> lists_;
};

}  // namespace delassus::inner
