/// An island whose velocities come from what its impulses add to the bodies, in the place of W's blocks.
#pragma once

#include <delassus/core/array.hpp>
#include <delassus/core/index.hpp>
#include <delassus/core/owning_array.hpp>
#include <delassus/rows/row_view.hpp>
#include <delassus/solvers/island.hpp>
#include <delassus/solvers/law_table.hpp>

#include <algorithm>
#include <cstddef>

namespace delassus::inner {

/// u = d + H y, y = A⁻¹ Hᵀ λ of each body, as `MatrixFreeCompliance` has it: a solver that seldom changes one
/// impulse alone asks for less so. Of each W_ii it needs the compliance besides.
template <class T>
class VelocitiesByBody {
 public:
  /// The island's passes and velocities are by bodies from here to `put_back`. False where W is no matrix.
  /// Pre: every entry has its G.
  bool show(Island<T>& island) {
    for (const Span<T>& span : island)
      if (!span.pool->is_matrix()) return false;
    begin_ = island.begin(), count_ = int(island.end() - island.begin());
    pools_.resize(std::size_t(count_));
    spans_.resize(std::size_t(count_));
    std::size_t sets = 0, rows = 0;
    for (const Span<T>& span : island)
      sets += std::size_t(span.pool->sets),
          rows += std::size_t(span.pool->rows) * std::size_t(span.pool->items);
    sets_.resize(sets);
    on_diagonal_.resize_for_overwrite(rows);
    find_bodies(island);
    SetBlocksView<T>* set = sets_.data();
    T* on_diagonal = on_diagonal_.data();
    for (int n = 0; n < count_; ++n) {
      const PoolView<T>& from = *begin_[n].pool;
      PoolView<T>& to = pools_[std::size_t(n)];
      to = from;
      for (int s = 0; s < from.sets; ++s) set[s] = from.set[s], set[s].y = y_[std::size_t(s)].data();
      to.form = FormOfW::bodies;
      to.set = set;
      to.on_diagonal = on_diagonal;
      for (const Index i : begin_[n])
        for (int k = 0; k < from.rows; ++k)
          on_diagonal[std::ptrdiff_t(from.rows) * i + k] = compliance_of(from, i, k);
      set += from.sets;
      on_diagonal += std::ptrdiff_t(from.rows) * from.items;
      spans_[std::size_t(n)] = {&to, begin_[n].items, begin_[n].count};
    }
    for (const Span<T>& span : spans_)
      for (const Index i : span) span.pool->table->changed(*span.pool, i, Island<T>::impulse(span, i));
    island.pass_over(spans_.data(), count_);
    return true;
  }
  void put_back(Island<T>& island) const { island.pass_over(begin_, count_); }

 private:
  static T compliance_of(const PoolView<T>& pool, Index i, int k) {
    const std::ptrdiff_t row = std::ptrdiff_t(pool.rows) * i + k;
    const T own = pool.compliance[row], share = pool.relative_compliance[row];
    return share == T(0) ? own
                         : own + share * (pool.own_diagonal[std::ptrdiff_t(pool.rows) * row + k] - own) /
                                     (T(1) + share);
  }

  /// y of all bodies that the island's items act on ← 0.
  void find_bodies(const Island<T>& island) {
    std::size_t sets = 0;
    for (const Span<T>& span : island) sets = std::max(sets, std::size_t(span.pool->sets));
    if (y_.size() < sets) y_.resize(sets);
    for (const Span<T>& span : island)
      for (int s = 0; s < span.pool->sets; ++s) {
        const SetBlocksView<T>& set = span.pool->set[s];
        Array<double>& y = y_[std::size_t(s)];
        for (const Index i : span)
          for (Index e = set.offset[i]; e < set.offset[i + 1]; ++e) {
            const std::size_t at = std::size_t(set.width) * std::size_t(set.block[e]),
                              end = at + std::size_t(set.width);
            if (y.size() < end) y.resize(end);
            std::fill(y.data() + at, y.data() + end, 0.0);
          }
      }
  }

  const Span<T>* begin_ = nullptr;
  int count_ = 0;
  Array<PoolView<T>> pools_;
  Array<Span<T>> spans_;
  Array<SetBlocksView<T>> sets_;
  Array<T> on_diagonal_;
  OwningArray<Array<double>> y_;  ///< by set and block
};

}  // namespace delassus::inner
