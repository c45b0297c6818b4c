/// What a solver of A x = b with a sparse matrix of small blocks offers, whichever way it factors.
#pragma once

#include <delassus/core/array.hpp>
#include <delassus/core/index.hpp>
#include <delassus/math/linear.hpp>

#include <concepts>
#include <span>
#include <utility>

namespace delassus {

/// A symmetric positive definite A of w × w blocks of T, factored again and again with one pattern.
template <class F, int w, class T>
concept Factorization = requires(F f, const F fixed, Index i, std::span<const std::pair<Index, Index>> pairs,
                                 const Mat<w, w, T> block, Array<Vec<w, T>>& x) {
  f.analyse(i, pairs);                       // how many blocks, and which pairs (i, j), i ≠ j, are not zero
  f.set_zero();                              // A = 0
  f.add_diagonal(i, block);                  // A_ii += block
  f.add_pair(i, i, block);                   // A_ij += block, A_ji += blockᵀ
  { f.factor() } -> std::same_as<bool>;      // false: A is not positive definite, and there is no factor
  { fixed.solve(x) } -> std::same_as<void>;  // x ← A⁻¹ x
};

}  // namespace delassus
