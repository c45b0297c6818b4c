/// Impulses of rows as a change of velocity.
#pragma once

#include <delassus/compliance/compliance.hpp>
#include <delassus/core/array.hpp>
#include <delassus/rows/row_system.hpp>

#include <cstddef>
#include <span>
#include <tuple>

namespace delassus {

/// change = A⁻¹ Hᵀ λ of one set: block by block through G where A is block-diagonal, else by one solve.
template <int s, class Set, class Rows>
void add_impulses(const Set& set, const Rows& rows, std::span<typename Set::Velocity> to,
                  Array<typename Set::Velocity>& scratch) {
  const bool is_coupled = inner::is_coupled(set);
  if (is_coupled) {
    scratch.resize(set.blocks());
    for (auto& x : scratch) set_all(x, typename Set::Scalar(0));
  }
  each_pool(rows, [&](auto, const auto& pool) {
    const auto& blocks = inner::part<s>(pool.sets);
    for (Index i = 0; i < pool.items(); ++i)
      for (Index e = blocks.offset[i]; e < blocks.offset[i + 1]; ++e) {
        if (is_coupled) scratch[blocks.block[e]] += blocks.H[e].transpose() * pool.lambda[i];
        else to[blocks.block[e]] += blocks.G[e] * pool.lambda[i];
      }
  });
  if constexpr (requires { set.solve(scratch); })
    if (is_coupled) {
      set.solve(scratch);
      for (std::size_t b = 0; b < to.size(); ++b) to[b] += scratch[b];
    }
}

}  // namespace delassus
