/// The diagonal blocks of W alone, from plain views of H and G.
#pragma once

#include <delassus/compliance/inner/block_matrix.hpp>
#include <delassus/core/index.hpp>
#include <delassus/core/ranges.hpp>
#include <delassus/math/eager.hpp>
#include <delassus/rows/free_velocity.hpp>
#include <delassus/rows/row_view.hpp>

#include <cstddef>

namespace delassus::inner {

/// W_ii = Σ H_e G_f over the pairs of entries e, f of an item on the same block, R × R, for these items of a
/// pool; `compliance` is what of its diagonal is the rows' own, 1/kg, R numbers an item. Pre: every entry has
/// its G.
template <int R, class T>
void set_own_blocks(const RowView<T>& view, Range items, T* diagonal, T* compliance) {
  for (Index i = items.first; i < items.last; ++i) {
    T* const own = diagonal + std::ptrdiff_t(R * R) * i;
    DELASSUS_UNROLL
    for (int k = 0; k < R * R; ++k) own[k] = T(0);
    for (const SetBlocksView<T>*set = view.set, *end = set + view.sets; set != end; ++set)
      for (Index e = set->offset[i]; e < set->offset[i + 1]; ++e)
        for (Index f = set->offset[i]; f < set->offset[i + 1]; ++f) {
          if (set->block[e] != set->block[f]) continue;
          const std::ptrdiff_t size = std::ptrdiff_t(R) * set->width;
          T block[R * R];
          if (set->width == 6)
            set_product<R, 6, R>(set->H + size * e, set->G + size * f, block);
          else
            set_block<R>(set->H + size * e, set->G + size * f, set->width, R, block);
          DELASSUS_UNROLL
          for (int k = 0; k < R * R; ++k) own[k] += block[k];
        }
    for (int k = 0; k < R; ++k) {
      const std::ptrdiff_t row = std::ptrdiff_t(R) * i + k;
      T& x = own[k * (R + 1)];
      compliance[row] = view.compliance[row] + view.relative_compliance[row] * x;
      x += compliance[row];
    }
  }
}

/// The same, as a function of the items.
template <int R, class T>
struct SetOwnBlocks {
  const RowView<T>& view;
  T *diagonal, *compliance;
  void operator()(Range items) const { set_own_blocks<R>(view, items, diagonal, compliance); }
};

/// y += G λ of every item: its impulses as the velocities of its bodies.
template <int R, class T>
void add_impulses_to_bodies(const RowView<T>& view) {
  for (Index i = 0; i < view.items; ++i) impulse_changed<R>(view, i, load<R>(view.lambda + std::ptrdiff_t(R) * i));
}

}  // namespace delassus::inner
