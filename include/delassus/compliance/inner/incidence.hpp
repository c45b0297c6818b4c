/// Which rows act on a block, and the columns A⁻¹ Hᵀ of a set whose blocks are coupled.
#pragma once

#include <delassus/core/array.hpp>
#include <delassus/rows/row_system.hpp>

#include <array>
#include <span>
#include <tuple>
#include <vector>

namespace delassus::inner {

/// For every set, pool and block: the entries (item, entry) that act there, in the order of insertion.
template <class Rows>
class Incidence {
 public:
  struct Entry {
    Index item, entry;
  };

  template <int s>
  void find(const Rows& rows, Index blocks) {
    for_each_index<Rows::pool_count>([&](auto p) {
      const auto& set = std::get<s>(rows.template pool<p>().sets);
      List& list = lists_[s * Rows::pool_count + p];
      if (set.block.empty()) return;  // nobody asks `at`
      list.start.assign(blocks + 1, 0);
      for (const Index b : set.block) ++list.start[b + 1];
      for (Index b = 0; b < blocks; ++b) list.start[b + 1] += list.start[b];
      list.next.assign(list.start.begin(), list.start.end());
      list.entries.resize(set.block.size());
      for (Index i = 0; i + 1 < Index(set.offset.size()); ++i)
        for (Index e = set.offset[i]; e < set.offset[i + 1]; ++e) list.entries[list.next[set.block[e]]++] = {i, e};
    });
  }

  /// Pre: pool p acts on set s.
  template <int s, int p>
  std::span<const Entry> at(Index block) const {
    const List& list = lists_[s * Rows::pool_count + p];
    return std::span<const Entry>(list.entries).subspan(list.start[block], list.start[block + 1] - list.start[block]);
  }

 private:
  struct List {
    Array<Index> start, next;
    Array<Entry> entries;
  };
  std::array<List, Rows::set_count * Rows::pool_count> lists_;
};

/// For a set whose A couples its blocks: whole columns A⁻¹ H_jᵀ, one solve a row.
template <class T, int w, int R>
struct ColumnsOf {
  Array<Index> items;
  std::vector<Array<Mat<w, R, T>>> columns;
};

template <class Rows>
class CoupledColumns;

template <class T, int... w, int... R>
class CoupledColumns<RowSystem<T, Widths<w...>, R...>> {
 public:
  using Rows = RowSystem<T, Widths<w...>, R...>;

  template <int s, class Set>
  void prepare(const Set& set, const Rows& rows) {
    auto& x = std::get<s>(scratch_);
    x.resize(set.blocks());
    for_each_index<Rows::pool_count>([&](auto p) {
      constexpr int r = Rows::template rows_of<p>;
      const auto& mine = std::get<s>(rows.template pool<p>().sets);
      auto& out = std::get<p>(std::get<s>(columns_));
      out.items.clear();
      for (Index i = 0; i + 1 < Index(mine.offset.size()); ++i)
        if (mine.offset[i] < mine.offset[i + 1]) out.items.push_back(i);
      if (out.columns.size() < out.items.size()) out.columns.resize(out.items.size());  // never fewer: columns keep their room
      for (std::size_t n = 0; n < out.items.size(); ++n) {
        const Index i = out.items[n];
        out.columns[n].resize(set.blocks());
        for (int k = 0; k < r; ++k) {
          for (auto& v : x) v.setZero();
          for (Index e = mine.offset[i]; e < mine.offset[i + 1]; ++e)
            x[mine.block[e]] += mine.H[e].row(k).transpose();
          set.solve(x);
          for (std::size_t b = 0; b < x.size(); ++b) out.columns[n][b].col(k) = x[b];
        }
      }
    });
  }

  /// f(b, j, H_e A⁻¹ H_jᵀ) for all items j of all pools b, e the entries of item i of pool a in set s; not where the two act
  /// on bodies that A does not couple.
  template <int s, int a, class F>
  void each(const Rows& rows, Index i, F&& f) const {
    const auto& mine = std::get<s>(rows.template pool<a>().sets);
    if (mine.offset[i] == mine.offset[i + 1]) return;
    for_each_index<Rows::pool_count>([&](auto b) {
      const auto& theirs = std::get<b>(std::get<s>(columns_));
      for (std::size_t n = 0; n < theirs.items.size(); ++n)
        for (Index e = mine.offset[i]; e < mine.offset[i + 1]; ++e)
          if (const auto& response = theirs.columns[n][mine.block[e]]; !is_zero(response))
            f(b, theirs.items[n], mine.H[e] * response);
    });
  }

 private:
  template <int width>
  using PerPool = std::tuple<ColumnsOf<T, width, R>...>;
  std::tuple<PerPool<w>...> columns_;
  std::tuple<Array<Vec<w, T>>...> scratch_;
};

}  // namespace delassus::inner
