/// How W is built as a matrix, row by row, from plain views of H and G.
#pragma once

#include <delassus/compliance/compliance.hpp>
#include <delassus/compliance/inner/block_matrix.hpp>
#include <delassus/compliance/inner/incidence.hpp>
#include <delassus/compliance/inner/nodal_rows.hpp>
#include <delassus/core/array.hpp>
#include <delassus/rows/block_row.hpp>
#include <delassus/rows/row_kind.hpp>
#include <delassus/rows/row_view.hpp>

#include <cstddef>

namespace delassus::inner {

/// Who knows A⁻¹ of a set: its blocks one by one, whole columns of a solve, or its nodes.
enum class HowCoupled : char { not_at_all, columns, nodes };

/// W of all pools, and what builds it. The rows are shown first, in `views`; then every set is prepared.
template <class T>
class AssembledRows {
 public:
  // Written out, so that who leaves them to `delassus::compiled` does not compile them.
  AssembledRows() {}
  AssembledRows(const AssembledRows&) = default;
  AssembledRows(AssembledRows&&) = default;
  AssembledRows& operator=(const AssembledRows&) = default;
  AssembledRows& operator=(AssembledRows&&) = default;
  ~AssembledRows() {}

  /// For so many pools and sets.
  void resize(int pools, int sets) {
    pools_ = pools;
    matrix.resize(pools);
    coupled.resize(std::size_t(sets), HowCoupled::not_at_all);
    views.resize(std::size_t(pools));
    sets_.resize(std::size_t(pools * sets));
  }
  SetBlocksView<T>* sets(int pool) { return sets_.data() + std::size_t(pool) * coupled.size(); }

  /// `by`: what several workers keep of the set, and the execution.
  template <class Set, class... By>
  void prepare(const Set& set, int s, By&... by) {
    if (coupled[std::size_t(s)] == HowCoupled::not_at_all) {
      moves_.resize(std::size_t(set.blocks()));
      for (Index b = 0; b < set.blocks(); ++b) moves_[std::size_t(b)] = set.moves(b);
      incidence_.find(views.data(), pools_, s, moves_);
    } else if constexpr (NodeCompliantSet<Set>)
      nodal_.prepare(set, views.data(), pools_, s, by...);
    else if constexpr (may_couple<Set>) columns_.prepare(set, views.data(), pools_, s);
  }

  /// The rows of pool a, `height` an item, whose items in `crowded` have no blocks, and of W_ii only their own compliance.
  /// `couples`: some set may have an A that couples its blocks.
  template <int height, bool couples>
  static void build_pool(AssembledRows& W, int a, const CrowdedRow* crowded);
  /// The same of items first … last − 1, in order, into `to`, whose rows of the pool are begun.
  template <int height, bool couples>
  static void build_rows(AssembledRows& W, BlockMatrix<T>& to, int a, Index first, Index last, const CrowdedRow* crowded);
  /// Whether a set that pool a acts on has an A that couples its blocks.
  bool is_coupled(int a) const {
    bool any = false;
    for (int s = 0; s < views[std::size_t(a)].sets; ++s) any = any || coupled[std::size_t(s)] != HowCoupled::not_at_all;
    return any;
  }

  /// r = d_i + Σ_{j ≠ i} W_ij λ_j of item i of pool a; `d` of this pool, λ of all, and how many rows an item of each has.
  template <int height>
  void sum_others(int a, Index i, const T* d, const T* const* lambda, const int* heights, double* r) const {
    for (int k = 0; k < height; ++k) r[k] = double(d[std::ptrdiff_t(height) * i + k]);
    for (int b = 0; b < pools_; ++b) {
      const auto& W = matrix.blocks(a, b);
      const Index first = W.start[i], last = W.start[i + 1];
      if (heights[b] == height) delassus::inner::add_row<height>(r, first, last, W.numbers.data(), W.column.data(), lambda[b]);
      else inner::add_wide_row<height>(r, first, last, W.numbers.data(), W.column.data(), lambda[b], heights[b]);
    }
  }

  BlockMatrix<T> matrix;
  Array<RowView<T>> views;  ///< of the rows that are being built
  Array<HowCoupled> coupled;  ///< by set

 private:
  /// Every entry e of item i meets all entries f on its block, if that moves, and W_ij += H_e G_f.
  template <int height>
  void add_row(BlockMatrix<T>& to, int a, int s, Index i) {
    const RowView<T>* const all = views.data();
    const SetBlocksView<T>& mine = all[a].set[s];
    const int pools = pools_;
    for (Index e = mine.offset[i]; e < mine.offset[i + 1]; ++e)
      for (int b = 0; b < pools; ++b) {
        const RowView<T>& other = all[b];
        const SetBlocksView<T>& theirs = other.set[s];
        if (theirs.offset[other.items] == 0) continue;
        const auto meeting = incidence_.at(s, b, mine.block[e]);
        const T* H = mine.H + std::ptrdiff_t(height * mine.width) * e;
        const int columns = other.rows;
        if (columns == height && mine.width == 6) {
          for (const auto& [j, f] : meeting) add_product<height, 6>(to, a, b, i, j, H, theirs.G + std::ptrdiff_t(6 * height) * f);
        } else if (columns == height && mine.width == 3) {
          for (const auto& [j, f] : meeting) add_product<height, 3>(to, a, b, i, j, H, theirs.G + std::ptrdiff_t(3 * height) * f);
        } else {
          for (const auto& [j, f] : meeting)
            add_wide_product<height>(to, a, b, i, j, H, theirs.G + std::ptrdiff_t(mine.width * columns) * f, mine.width, columns);
        }
      }
  }
  template <int height, int width>
  [[gnu::always_inline]] static void add_product(BlockMatrix<T>& to, int a, int b, Index i, Index j, const T* H, const T* G) {
    T block[height * height];
    set_product<height, width, height>(H, G, block);
    to.template add<height>(a, b, i, j, height, block);
  }
  template <int height>
  static void add_wide_product(BlockMatrix<T>& to, int a, int b, Index i, Index j, const T* H, const T* G, int width, int columns) {
    T block[height * most_rows];
    set_block<height>(H, G, width, columns, block);
    to.template add<height>(a, b, i, j, columns, block);
  }

  /// The sets whose blocks A couples.
  template <int height>
  void add_coupled(BlockMatrix<T>& to, int a, Index i) {
    for (int s = 0; s < int(coupled.size()); ++s) {
      if (coupled[std::size_t(s)] == HowCoupled::nodes)
        nodal_.each(views.data(), s, a, i, to.room_along, to.room_of_block, [&](int b, Index j, const T* block) {
          to.template add<height>(a, b, i, j, views[std::size_t(b)].rows, block);
        });
      else if (coupled[std::size_t(s)] == HowCoupled::columns)
        columns_.each(views.data(), s, a, i, [&](int b, Index j, const T* H, const T* response, int width) {
          add_wide_product<height>(to, a, b, i, j, H, response, width, views[std::size_t(b)].rows);
        });
    }
  }

  int pools_ = 0;
  Array<SetBlocksView<T>> sets_;
  Array<char> moves_;  ///< by block of the set that is prepared
  Incidence<T> incidence_;
  CoupledColumns<T> columns_;
  NodalRows<T> nodal_;
};

template <class T>
template <int height, bool couples>
void AssembledRows<T>::build_pool(AssembledRows& W, int a, const CrowdedRow* crowded) {
  if (W.matrix.begin_rows(W.views.data(), a)) build_rows<height, couples>(W, W.matrix, a, 0, W.views[std::size_t(a)].items, crowded);
}

template <class T>
template <int height, bool couples>
void AssembledRows<T>::build_rows(AssembledRows& W, BlockMatrix<T>& to, int a, Index first, Index last, const CrowdedRow* crowded) {
  const RowView<T>& mine = W.views[std::size_t(a)];
  const bool any_coupled = couples && W.is_coupled(a);
  for (Index i = first; i < last; ++i) {
    to.template begin_row<height>(a, i);
    if (!crowded || !crowded[i].is_crowded) {
      if constexpr (couples)
        if (any_coupled) W.template add_coupled<height>(to, a, i);
      for (int s = 0; s < mine.sets; ++s)
        if (!any_coupled || W.coupled[std::size_t(s)] == HowCoupled::not_at_all) W.template add_row<height>(to, a, s, i);
    }
    to.end_row(mine, a, i);
  }
}

}  // namespace delassus::inner
