/// The rows of a pool as a view of them.
#pragma once

#include <delassus/core/index.hpp>
#include <delassus/rows/pool_rows.hpp>
#include <delassus/rows/row_view.hpp>

namespace delassus::inner {

template <int R, int w, class T>
void show_set(const SetBlocks<R, w, T>& blocks, SetBlocksView<T>& view) {
  const bool has_G = blocks.G.size() == blocks.H.size();
  view = {blocks.offset.data(), blocks.block.data(), blocks.H.numbers.data(), has_G ? blocks.G.numbers.data() : nullptr, nullptr, w};
}

/// All of `view` but W and the law. `sets` has room for one view a body set, and stays where it is.
template <int R, class T, int... w>
void show_rows(PoolRows<R, T, w...>& rows, int pool, RowView<T>& view, SetBlocksView<T>* sets) {
  view.pool = pool;
  view.rows = R;
  view.items = rows.items();
  view.lambda = rows.lambda.numbers.data();
  view.d = rows.d.numbers.data();
  view.bias = rows.bias.numbers.data();
  view.compliance = rows.compliance.numbers.data();
  view.relative_compliance = rows.relative_compliance.numbers.data();
  view.set = sets;
  view.sets = int(sizeof...(w));
  rows.sets.each([&](const auto& s) __attribute__((always_inline)) { show_set(s, *sets++); });
}

}  // namespace delassus::inner
