/// The rows of a pool as a view of them.
#pragma once

#include <delassus/core/index.hpp>
#include <delassus/rows/pool_rows.hpp>
#include <delassus/rows/row_view.hpp>

#include <type_traits>

namespace delassus::inner {

/// The numbers of a list of small matrices.
template <class List>
[[gnu::always_inline]] inline auto* numbers_of(List& list) {
  if constexpr (requires { list.numbers; }) {
    return list.numbers.data();
  } else {
    using M = typename List::value_type;
    if constexpr (std::is_const_v<List>) return reinterpret_cast<const typename M::Scalar*>(list.data());
    else return reinterpret_cast<typename M::Scalar*>(list.data());
  }
}

template <int R, int w, class T>
void show_set(const SetBlocks<R, w, T>& blocks, SetBlocksView<T>& view) {
  const bool has_G = blocks.G.size() == blocks.H.size();
  view = {blocks.offset.data(), blocks.block.data(), inner::numbers_of(blocks.H), has_G ? inner::numbers_of(blocks.G) : nullptr, nullptr, w};
}

/// All of `view` but W and the law. `sets` has room for one view a body set, and stays where it is.
template <int R, class T, int... w>
void show_rows(PoolRows<R, T, w...>& rows, int pool, RowView<T>& view, SetBlocksView<T>* sets) {
  view.pool = pool;
  view.rows = R;
  view.items = rows.items();
  view.lambda = inner::numbers_of(rows.lambda);
  view.d = inner::numbers_of(rows.d);
  view.bias = inner::numbers_of(rows.bias);
  view.compliance = inner::numbers_of(rows.compliance);
  view.relative_compliance = inner::numbers_of(rows.relative_compliance);
  view.set = sets;
  view.sets = int(sizeof...(w));
  rows.sets.each([&](const auto& s) __attribute__((always_inline)) { show_set(s, *sets++); });
}

}  // namespace delassus::inner
