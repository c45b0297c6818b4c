/// The impulses of all pools, set aside.
#pragma once

#include <delassus/core/pack.hpp>
#include <delassus/core/block_array.hpp>
#include <delassus/rows/row_system.hpp>

#include <cstddef>

namespace delassus {

/// One vector of λ_i a pool.
template <class Rows>
struct Impulses;
template <class T, int... w, int... R>
struct Impulses<RowSystem<T, Widths<w...>, R...>> {
  using Rows = RowSystem<T, Widths<w...>, R...>;
  inner::Pack<BlockArray<Vec<R, T>>...> pools;

  void resize_like(const Rows& rows) {
    for_each_index<sizeof...(R)>([&](auto p) { inner::part<p>(pools).resize(rows.template pool<p>().items()); });
  }
  void set_zero() {
    for_each_index<sizeof...(R)>([&](auto p) {
      for (auto& x : inner::part<p>(pools)) x.setZero();
    });
  }
  void add(const Impulses& more, T share = 1) {
    for_each_index<sizeof...(R)>([&](auto p) {
      auto& to = inner::part<p>(pools);
      for (std::size_t i = 0; i < to.size(); ++i) to[i] += share * inner::part<p>(more.pools)[i];
    });
  }
  /// λ of the rows ← these.
  void give_to(Rows& rows) const {
    for_each_index<sizeof...(R)>([&](auto p) { rows.template pool<p>().lambda = inner::part<p>(pools); });
  }
};

}  // namespace delassus
