/// How W is built as a matrix, row by row, from plain views of H and G.
#pragma once

#include <delassus/compliance/compliance.hpp>
#include <delassus/compliance/inner/block_matrix.hpp>
#include <delassus/compliance/inner/incidence.hpp>
#include <delassus/compliance/inner/nodal_rows.hpp>
#include <delassus/core/array.hpp>
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

  template <class Set>
  void prepare(const Set& set, int s) {
    if (coupled[std::size_t(s)] == HowCoupled::not_at_all) incidence_.find(views.data(), pools_, s, set.blocks());
    else if constexpr (NodeCompliantSet<Set>) nodal_.prepare(set, views.data(), pools_, s);
    else if constexpr (may_couple<Set>) columns_.prepare(set, views.data(), pools_, s);
  }

  /// The rows of pool a, `height` an item, whose items in `crowded` have no blocks, and of W_ii only their own compliance.
  template <int height>
  static void build_pool(AssembledRows& W, int a, const CrowdedRow* crowded);

  BlockMatrix<T> matrix;
  Array<RowView<T>> views;  ///< of the rows that are being built
  Array<HowCoupled> coupled;  ///< by set

 private:
  /// Every entry e of item i meets all entries f on its block, and W_ij += H_e G_f.
  template <int height>
  void add_row(int a, int s, Index i) {
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
          for (const auto& [j, f] : meeting) add_product<height, 6>(a, b, i, j, H, theirs.G + std::ptrdiff_t(6 * height) * f);
        } else if (columns == height && mine.width == 3) {
          for (const auto& [j, f] : meeting) add_product<height, 3>(a, b, i, j, H, theirs.G + std::ptrdiff_t(3 * height) * f);
        } else {
          for (const auto& [j, f] : meeting)
            add_wide_product<height>(a, b, i, j, H, theirs.G + std::ptrdiff_t(mine.width * columns) * f, mine.width, columns);
        }
      }
  }
  template <int height, int width>
  [[gnu::always_inline]] void add_product(int a, int b, Index i, Index j, const T* H, const T* G) {
    T block[height * height];
    set_product<height, width, height>(H, G, block);
    matrix.template add<height>(a, b, i, j, height, block);
  }
  template <int height>
  void add_wide_product(int a, int b, Index i, Index j, const T* H, const T* G, int width, int columns) {
    T block[height * most_rows];
    set_block<height>(H, G, width, columns, block);
    matrix.template add<height>(a, b, i, j, columns, block);
  }

  /// The sets whose blocks A couples.
  template <int height>
  void add_coupled(int a, Index i) {
    for (int s = 0; s < int(coupled.size()); ++s) {
      if (coupled[std::size_t(s)] == HowCoupled::nodes)
        nodal_.each(views.data(), s, a, i, [&](int b, Index j, const T* block) {
          matrix.template add<height>(a, b, i, j, views[std::size_t(b)].rows, block);
        });
      else if (coupled[std::size_t(s)] == HowCoupled::columns)
        columns_.each(views.data(), s, a, i, [&](int b, Index j, const T* H, const T* response, int width) {
          add_wide_product<height>(a, b, i, j, H, response, width, views[std::size_t(b)].rows);
        });
    }
  }

  int pools_ = 0;
  Array<SetBlocksView<T>> sets_;
  Incidence<T> incidence_;
  CoupledColumns<T> columns_;
  NodalRows<T> nodal_;
};

template <class T>
template <int height>
void AssembledRows<T>::build_pool(AssembledRows& W, int a, const CrowdedRow* crowded) {
  const RowView<T>& mine = W.views[std::size_t(a)];
  if (!W.matrix.begin_rows(W.views.data(), a)) return;
  const HowCoupled* const coupled = W.coupled.data();
  bool any_coupled = false;
  for (int s = 0; s < mine.sets; ++s) any_coupled = any_coupled || coupled[s] != HowCoupled::not_at_all;
  for (Index i = 0; i < mine.items; ++i) {
    W.matrix.template begin_row<height>(a, i);
    if (!crowded || !crowded[i].is_crowded) {
      if (any_coupled) W.template add_coupled<height>(a, i);
      for (int s = 0; s < mine.sets; ++s)
        if (coupled[s] == HowCoupled::not_at_all) W.template add_row<height>(a, s, i);
    }
    W.matrix.end_row(mine, a, i);
  }
}

}  // namespace delassus::inner
