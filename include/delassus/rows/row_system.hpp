/// All rows of one step: one PoolRows per pool of constraints.
#pragma once

#include <delassus/core/pack.hpp>
#include <delassus/rows/pool_rows.hpp>

#include <algorithm>
#include <array>
#include <cstddef>
#include <tuple>
#include <type_traits>
#include <utility>

namespace delassus {

/// Velocities per block of each body set, in the world's order.
template <int... w>
struct Widths {};

template <class T, class Widths, int... R>
struct RowSystem;

template <class T, int... w, int... R>
struct RowSystem<T, Widths<w...>, R...> {
  using Scalar = T;
  static constexpr int pool_count = int(sizeof...(R));
  static constexpr int set_count = int(sizeof...(w));

  /// Rows per item of pool p, velocities per block of set s.
  template <int p>
  static constexpr int rows_of = std::array<int, sizeof...(R) + 1>{R..., 0}[p];
  template <int s>
  static constexpr int width_of = std::array<int, sizeof...(w) + 1>{w..., 0}[s];

  /// The most velocities per block, and rows per item; the least of the latter.
  static constexpr int widest = std::max({0, w...}), highest = std::max({0, R...}), lowest = std::min({highest, R...});

  inner::Pack<PoolRows<R, T, w...>...> pools;

  template <int p>
  auto& pool() {
    return inner::part<p>(pools);
  }
  template <int p>
  const auto& pool() const {
    return inner::part<p>(pools);
  }

  /// No item in any pool.
  void reset() {
    pools.each([](auto& p) { p.reset(0); });
  }

  static void each_array(auto& self, auto&& f) {
    self.pools.each([&](auto& p) { p.each_array(p, f); });
  }

  Index row_count() const {
    Index count = 0;
    pools.each([&](const auto& p) __attribute__((always_inline)) { count += p.items() * p.rows; });
    return count;
  }
};

/// Calls f(std::integral_constant<int, 0>{}), … in order: a loop over pools or sets, unrolled.
template <int count, class F>
[[gnu::always_inline]] constexpr void for_each_index(F&& f) {
  [&]<int... i>(std::integer_sequence<int, i...>) __attribute__((always_inline)) {
    (f(std::integral_constant<int, i>{}), ...);
  }(std::make_integer_sequence<int, count>{});
}

/// f(p, pool) for every pool of rows, or of constraints.
[[gnu::always_inline]] inline void each_pool(auto& all, auto&& f) {
  [&]<int... p>(std::integer_sequence<int, p...>) __attribute__((always_inline)) {
    (f(std::integral_constant<int, p>{}, all.template pool<p>()), ...);
  }(std::make_integer_sequence<int, std::remove_cvref_t<decltype(all)>::pool_count>{});
}

}  // namespace delassus
