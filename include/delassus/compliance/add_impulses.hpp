/// Impulses of rows as a change of velocity.
#pragma once

#include <delassus/compliance/compliance.hpp>
#include <delassus/core/array.hpp>
#include <delassus/core/slice.hpp>
#include <delassus/rows/row_arrays.hpp>

#include <cstddef>

namespace delassus {

/// to += A⁻¹ Hᵀ λ of set number s: block by block through G where A is block-diagonal, else by one solve.
template <class Set>
void add_impulses(const Set& set, int s, AllRows<typename Set::Scalar> rows, inner::Slice<typename Set::Velocity> to,
                  Array<typename Set::Velocity>& scratch) {
  using T = typename Set::Scalar;
  if (!inner::is_coupled(set)) {
    for (const RowArrays<T>& pool : rows)
      pool.set[s].products->add_motion(pool.set[s], pool.items(), pool.lambda->data(), reinterpret_cast<T*>(to.data()));
    return;
  }
  if constexpr (requires { set.solve(scratch); }) {
    scratch.resize(set.blocks());
    for (auto& x : scratch) set_all(x, T(0));
    for (const RowArrays<T>& pool : rows)
      pool.set[s].products->add_impulse(pool.set[s], pool.items(), pool.lambda->data(), reinterpret_cast<T*>(scratch.data()));
    set.solve(scratch);
    for (std::size_t b = 0; b < to.size(); ++b) to[b] += scratch[b];
  }
}

}  // namespace delassus
