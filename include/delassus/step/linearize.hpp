/// Linearize: every law writes H and φ of its items.
#pragma once

#include <delassus/core/cmath.hpp>
#include <delassus/rows/row_arrays.hpp>
#include <delassus/rows/soft.hpp>
#include <delassus/rows/world_view.hpp>
#include <delassus/step/law_rows.hpp>

#include <algorithm>
#include <cstddef>

namespace delassus {

/// Items that remember something of their pose see the start of the step.
template <class T>
void follow(const WorldView<T>& world, AllLaws<T> laws) {
  for (const LawPool<T>& pool : laws)
    if (pool.law->follow) pool.law->follow(pool.pool, world);
}
template <class World, class Laws>
void follow(const World& world, Laws& laws) {
  follow(ViewOf<World>(world), PoolsOf<Laws, typename World::Scalar>(laws).all());
}

/// H and φ at the present configuration of the world.
template <class T>
void linearize(const WorldView<T>& world, AllLaws<T> laws, AllRows<T> rows) {
  for (std::size_t p = 0; p < laws.size(); ++p) {
    const Index items = laws[p].law->count(laws[p].pool);
    rows[p].reset(items);
    laws[p].law->linearize(laws[p].pool, world, rows[p], 0, items);
  }
}
template <class World, class Laws, class Rows>
void linearize(const World& world, const Laws& laws, Rows& rows) {
  using T = typename World::Scalar;
  linearize(ViewOf<World>(world), PoolsOf<Laws, T>(laws).all(), ArraysOf<Rows>(rows).all());
}

/// The largest |φ| among the rows that are equalities, m or rad.
template <class T>
double worst_equality(AllLaws<T> laws, AllRows<T> rows) {
  double worst = 0;
  for (std::size_t p = 0; p < laws.size(); ++p) {
    const RowArrays<T>& pool = rows[p];
    const RowKind* const kinds = laws[p].law->kinds;
    const int height = pool.rows;
    const T *phi = pool.phi->begin(), *const end = pool.phi->end(), *stiffness = pool.stiffness->begin(), *damping = pool.damping->begin();
    for (; phi != end; phi += height, stiffness += height, damping += height)
      for (int k = 0; k < height; ++k)
        if (kinds[k] == RowKind::equality && !inner::is_spring(stiffness[k], damping[k])) worst = std::max(worst, double(std::abs(phi[k])));
  }
  return worst;
}

/// Of all pools.
template <class T>
Index row_count(AllRows<T> rows) {
  Index count = 0;
  for (const RowArrays<T>& pool : rows) count += Index(pool.phi->size());
  return count;
}

}  // namespace delassus
