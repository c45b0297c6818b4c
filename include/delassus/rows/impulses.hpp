/// The impulses of all pools, set aside.
#pragma once

#include <delassus/core/array.hpp>
#include <delassus/rows/row_system.hpp>

#include <tuple>

namespace delassus {

/// One vector of λ_i a pool.
template <class Rows>
struct Impulses;
template <class T, int... w, int... R>
struct Impulses<RowSystem<T, Widths<w...>, R...>> {
  std::tuple<Array<Vec<R, T>>...> pools;

  void resize_like(const RowSystem<T, Widths<w...>, R...>& rows) {
    for_each_index<sizeof...(R)>([&](auto p) { std::get<p>(pools).resize(rows.template pool<p>().items()); });
  }
};

}  // namespace delassus
