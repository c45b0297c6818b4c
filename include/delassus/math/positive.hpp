/// The inverse of a small positive definite matrix.
#pragma once

#include <delassus/core/cmath.hpp>
#include <delassus/core/unrolled.hpp>
#include <delassus/math/linear.hpp>

#include <limits>

namespace delassus {

/// S⁻¹ = L⁻ᵀ L⁻¹ with S = L Lᵀ, R × R and symmetric positive definite; only the lower half of S is read. Zero where S is:
/// rows that nothing answers to get no impulse.
///
/// Fixed trip counts, so that everything unrolls: Eigen's llt().solve(1) goes through the kernels of its large matrices,
/// 900 instructions for 3 × 3 where this takes 100.
template <int R, class T>
Mat<R, R, T> inverse_of_positive(const Mat<R, R, T>& S) {
  auto K = zero<Mat<R, R, T>>();  // L⁻¹, row by row as L's rows are found
  for (int i = 0; i < R; ++i) {
    Vec<R, T> row;  // row i of L
    T pivot = S(i, i);
    for (int j = 0; j < i; ++j) {
      T sum = 0;
      for (int k = 0; k <= j; ++k) sum += K(j, k) * S(i, k);
      row[j] = sum;
      pivot -= sum * sum;
    }
    const T over = pivot > T(0) ? T(1) / std::sqrt(pivot) : T(0);
    for (int j = 0; j < i; ++j) {
      T sum = 0;
      for (int k = j; k < i; ++k) sum += row[k] * K(k, j);
      K(i, j) = -over * sum;
    }
    K(i, i) = over;
  }
  return transposed(K) * K;
}

/// x = S⁻¹ b by S = L D Lᵀ, where one right-hand side is all there is: half of what the inverse takes. Only
/// S_ij, i ≥ j, is read. A pivot that cancellation has left nothing of but rounding, 64 ε S_ii, is of a row
/// that the ones before it make redundant: its x is zero.
template <int R, class T>
Vec<R, T> solve_positive(const Mat<R, R, T>& S, const Vec<R, T>& b) {
  Mat<R, R, T> L;
  Vec<R, T> over, x = b;  // D⁻¹
  unrolled<R>([&]<int i>() {
    T pivot = S(i, i);
    Vec<R, T> row;  // of L D
    unrolled<i>([&]<int j>() {
      T sum = S(i, j);
      unrolled<j>([&]<int k>() { sum -= row[k] * L(j, k); });
      row[j] = sum;
      L(i, j) = sum * over[j];
      pivot -= sum * L(i, j);
      x[i] -= L(i, j) * x[j];
    });
    over[i] = pivot > T(64) * std::numeric_limits<T>::epsilon() * S(i, i) ? T(1) / pivot : T(0);
  });
  unrolled<R>([&]<int n>() {
    constexpr int i = R - 1 - n;
    x[i] *= over[i];
    unrolled<n>([&]<int m>() { x[i] -= L(R - 1 - m, i) * x[R - 1 - m]; });
  });
  return x;
}

}  // namespace delassus
