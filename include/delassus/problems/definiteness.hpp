/// Whether the W of a friction problem is one: no impulse may do negative work.
#pragma once

#include <delassus/linear/block_cholesky.hpp>
#include <delassus/problems/friction_problem.hpp>

#include <utility>
#include <vector>

namespace delassus {

/// The first contact k whose impulses, with those of contacts 0 … k − 1, can have λᵀ W λ < −10⁻⁵ Σ W_kk λ_k²; −1 where W is
/// positive semidefinite to that, as W = H A⁻¹ Hᵀ is, written with six digits. Of a W that is not symmetric ½(W + Wᵀ) is
/// asked. By Cholesky's factors of leading blocks, in halves.
inline Index first_indefinite_contact(const FrictionProblem& p) {
  constexpr double rounding = 1e-5;
  const auto W = p.W.blocks<0, 0>();
  const auto is_definite = [&](Index count) {
    std::vector<std::pair<Index, Index>> pairs;
    for (Index i = 0; i < count; ++i)
      for (Index e = W.start[i]; e < W.start[i + 1]; ++e)
        if (W.column[e] < count) pairs.emplace_back(i, W.column[e]);
    BlockCholesky<3, double> factors;
    factors.analyse(count, pairs);
    factors.set_zero();
    for (Index i = 0; i < count; ++i) {
      const Mat3& own = p.W.diagonal<0>(i);
      Mat3 lifted = 0.5 * (own + own.transpose());
      for (int k = 0; k < 3; ++k) lifted(k, k) += rounding * own(k, k);
      factors.add_diagonal(i, lifted);
      for (Index e = W.start[i]; e < W.start[i + 1]; ++e)
        if (W.column[e] < count) factors.add_pair(i, W.column[e], Mat3(0.5 * W.block[e]));
    }
    return factors.factor();
  };
  Index high = p.rows.pool<0>().items(), low = 0;  // the contacts before `low` are definite
  if (is_definite(high)) return -1;
  while (high - low > 1) {
    const Index middle = low + (high - low) / 2;
    (is_definite(middle) ? low : high) = middle;
  }
  return low;
}

}  // namespace delassus
