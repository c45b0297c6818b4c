/// H x: the rate at which velocities x change the rows of an item.
#pragma once

#include <delassus/core/index.hpp>
#include <delassus/math/linear.hpp>
#include <delassus/rows/pool_rows.hpp>
#include <delassus/rows/row_system.hpp>

namespace delassus::inner {

/// H x of item i of a pool.
template <int R, class T, int... w, class World, class Member>
Vec<R, T> rate(const PoolRows<R, T, w...>& pool, Index i, const World& world, const Member& member) {
  auto u = zero<Vec<R, T>>();
  world.each([&](const auto& set, auto s) {
    const auto& blocks = inner::part<s>(pool.sets);
    const auto& v = member(set);
    for (Index e = blocks.offset[i]; e < blocks.offset[i + 1]; ++e) u += blocks.H[e] * v[blocks.block[e]];
  });
  return u;
}

/// H v_next.
auto next_rate(const auto& pool, Index i, const auto& world) {
  return rate(pool, i, world, [](const auto& set) -> const auto& { return set.v_next; });
}

}  // namespace delassus::inner
