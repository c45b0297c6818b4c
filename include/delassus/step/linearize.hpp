/// Linearize: every law writes H and φ of its items.
#pragma once

#include <delassus/constraints/constraints.hpp>
#include <delassus/rows/row_system.hpp>
#include <delassus/rows/writer.hpp>

#include <algorithm>
#include <cmath>
#include <utility>

namespace delassus {

/// Items that remember something of their pose (how often a wheel has turned) see the start of the step.
template <class World, class Laws>
void follow(const World& world, Laws& laws) {
  each_pool(laws, [&](auto, auto& pool) {
    if constexpr (refines<std::remove_cvref_t<decltype(pool.law)>>(refine::follow))
      for (const Index place : pool.slots.active()) pool.law.follow(pool.items[place], world);
  });
}

/// H and φ at the present configuration of the world.
template <class World, class Laws, class Rows>
void linearize(const World& world, const Laws& laws, Rows& rows) {
  each_pool(laws, [&](auto p, const auto& pool) {
    auto& out = rows.template pool<p>();
    using Pool = std::remove_cvref_t<decltype(out)>;
    out.reset(pool.count());
    for (Index i = 0; i < pool.count(); ++i) {
      pool.law.linearize(pool.item(i), world, RowWriter<World, Pool>(world, out, i));
      out.close();
    }
  });
}

/// The largest |φ| among the rows that are equalities, m or rad.
template <class Laws, class Rows>
double worst_equality(const Laws& laws, const Rows& rows) {
  double worst = 0;
  each_pool(rows, [&](auto p, const auto& pool) {
    using Law = std::remove_cvref_t<decltype(laws.template pool<p>().law)>;
    constexpr auto kinds = row_kinds<Law>();
    for (Index i = 0; i < pool.items(); ++i)
      for (int k = 0; k < Law::rows; ++k)
        if (kinds[k] == RowKind::equality && !(pool.stiffness[i][k] > 0 || pool.damping[i][k] > 0))
          worst = std::max(worst, double(std::abs(pool.phi[i][k])));
  });
  return worst;
}

}  // namespace delassus
