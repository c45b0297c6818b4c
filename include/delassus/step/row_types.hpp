/// The types of the rows that a world and its laws have.
#pragma once

#include <delassus/bodies/world.hpp>
#include <delassus/constraints/constraints.hpp>
#include <delassus/core/array.hpp>
#include <delassus/rows/row_system.hpp>

#include <tuple>

namespace delassus::inner {

template <class World>
struct widths_of;
template <class... S>
struct widths_of<World<S...>> {
  using type = Widths<S::width...>;
  using Scratch = Pack<Array<typename S::Velocity>...>;
};

template <class W, int R, class Widths = typename widths_of<W>::type>
struct pool_rows_of;
template <class W, int R, int... w>
struct pool_rows_of<W, R, Widths<w...>> {
  using type = PoolRows<R, typename W::Scalar, w...>;
};
/// The rows that a law with R of them has over a world.
template <class W, int R>
using PoolRowsOf = typename pool_rows_of<W, R>::type;

template <class World, class Laws>
struct rows_of;
template <class World, class... L>
struct rows_of<World, Constraints<L...>> {
  using type = RowSystem<typename World::Scalar, typename widths_of<World>::type, L::rows...>;
};

}  // namespace delassus::inner
