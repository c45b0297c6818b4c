/// The Delassus operator row by row in the form that costs a sweep less.
#pragma once

#include <delassus/compliance/assembled.hpp>
#include <delassus/compliance/matrix_free.hpp>
#include <delassus/core/array.hpp>

#include <algorithm>
#include <array>

namespace delassus {

/// Σ_j W_ij λ_j over the blocks of a row that has few; H y with y = A⁻¹ Hᵀ λ for a row that would have many,
/// which W does without. So what a visit costs is bounded, whatever else acts on its bodies. Which form a row
/// takes is decided by its own bodies. Where A couples bodies (springs under an implicit integrator, soft
/// bodies) all rows are W's.
struct CheaperCompliance {
  using plays = role::Compliance;

  template <class Rows>
  class Operator;
};

/// W of one loop, in both forms; what its functions do stands at `Compliance`.
template <class T, int... w, int... R>
class CheaperCompliance::Operator<RowSystem<T, Widths<w...>, R...>> {
 public:
  using Rows = RowSystem<T, Widths<w...>, R...>;  ///< H, d, λ of one step
  using Sum = double;                             ///< in which rows are summed
  static constexpr int pools = Rows::pool_count;  ///< one for each law

  /// An item is crowded if more rows than these act on its bodies, its own counted once a body: those of
  /// eight contacts. H y takes as long as about so many blocks (docs/evidence/performance.md).
  static constexpr Index most_rows = 24;

  void build(const auto& world, Rows& rows) {
    is_whole_ = false;
    world.each([&](const auto& set, auto) { is_whole_ = is_whole_ || inner::is_coupled(set); });
    if (is_whole_) return matrix_.build(world, rows);
    bodies_.build(world, rows);
    find_crowded(world, rows);
    const CrowdedRow* crowded[pools];
    for (int p = 0; p < pools; ++p) crowded[p] = kinds_[p].data();
    matrix_.build_where(world, rows, crowded);
  }

  void reset(const Rows& rows) {
    if (!is_whole_ && has_crowded_) bodies_.reset(rows);
  }

  template <int p>
  const auto& diagonal(Index i) const {
    return is_whole_ ? matrix_.template diagonal<p>(i) : bodies_.template diagonal<p>(i);
  }

  /// The arrays that a solver reads of row p.
  template <int p>
  void show(const Rows& rows, RowView<T>& view, SetBlocksView<T>* sets, BlockRowsView<T>* blocks) {
    matrix_.template show<p>(rows, view, sets, blocks);
    if (is_whole_) return;
    const FormOfW of_blocks = view.form;
    bodies_.template show<p>(rows, view, sets, blocks);
    view.form = has_crowded_ ? FormOfW::mixed : of_blocks;
    view.crowded = kinds_[p].data();
  }

  /// (d + W λ)_i, by the form of item i.
  template <int p>
  [[gnu::always_inline]] Vec<Rows::template rows_of<p>, T> residual(const Rows& rows, Index i) const {
    return is_crowded<p>(i) ? bodies_.template residual<p>(rows, i) : matrix_.template residual<p>(rows, i);
  }

  /// d_i + Σ_{j ≠ i} W_ij λ_j: what the rows would do without this constraint.
  template <int p>
  [[gnu::always_inline]] Vec<Rows::template rows_of<p>, T> free_velocity(const Rows& rows, Index i) const {
    if (!is_crowded<p>(i)) return matrix_.template free_velocity<p>(rows, i);
    return bodies_.template residual<p>(rows, i) -
           bodies_.template diagonal<p>(i) * rows.template pool<p>().lambda[i];
  }

  template <int p>
  [[gnu::always_inline]] void commit(const Rows& rows, Index i,
                                     const Vec<Rows::template rows_of<p>, T>& change) {
    if (!is_whole_ && kinds_[p][i].meets_crowded) bodies_.template commit<p>(rows, i, change);
  }

  /// Whether item i of pool p is answered by its bodies, without blocks.
  template <int p>
  bool is_crowded(Index i) const {
    return !is_whole_ && kinds_[p][i].is_crowded;
  }

 private:
  struct Block {
    Index rows;
    bool is_crowded;
  };

  void find_crowded(const auto& world, const Rows& rows) {
    world.each([&](const auto& set, auto s) { blocks_[s].assign(set.blocks(), {}); });
    each_entry(rows, [&](auto p, Index, Block& block) { block.rows += Rows::template rows_of<p>; });
    for_each_index<pools>([&](auto p) { kinds_[p].assign(rows.template pool<p>().items(), {}); });
    has_crowded_ = false;
    for_each_index<pools>([&](auto p) {
      for (Index i = 0; i < Index(kinds_[p].size()); ++i) {
        Index sum = 0;
        each_entry_of<p>(rows, i, [&](Block& block) { sum += block.rows; });
        if (sum <= most_rows) continue;
        kinds_[p][i].is_crowded = has_crowded_ = true;
        each_entry_of<p>(rows, i, [&](Block& block) { block.is_crowded = true; });
      }
    });
    each_entry(rows, [&](auto p, Index i, const Block& block) {
      kinds_[p][i].meets_crowded = kinds_[p][i].meets_crowded || block.is_crowded;
    });
  }

  /// f(block) for every entry of item i.
  template <int p, class F>
  void each_entry_of(const Rows& rows, Index i, F&& f) {
    for_each_index<Rows::set_count>([&](auto s) {
      const auto& set = inner::part<s>(rows.template pool<p>().sets);
      for (Index e = set.offset[i]; e < set.offset[i + 1]; ++e) f(blocks_[s][set.block[e]]);
    });
  }
  /// f(pool, item, block) for every entry of every item.
  void each_entry(const Rows& rows, auto&& f) {
    for_each_index<pools>([&](auto p) {
      for (Index i = 0; i < rows.template pool<p>().items(); ++i)
        each_entry_of<p>(rows, i, [&](Block& block) { f(p, i, block); });
    });
  }

  AssembledCompliance::Operator<Rows> matrix_;
  MatrixFreeCompliance::Operator<Rows> bodies_;
  std::array<Array<Block>, Rows::set_count> blocks_;
  std::array<Array<CrowdedRow>, pools> kinds_;
  bool is_whole_ = false, has_crowded_ = false;
};

}  // namespace delassus
