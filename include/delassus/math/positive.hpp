/// The inverse of a small positive definite matrix.
#pragma once

#include <delassus/math/linear.hpp>

#include <cmath>

namespace delassus {

/// S⁻¹ = L⁻ᵀ L⁻¹ with S = L Lᵀ, R × R and symmetric positive definite; only the lower half of S is read. Zero where S is:
/// rows that nothing answers to get no impulse.
///
/// Fixed trip counts, so that everything unrolls: Eigen's llt().solve(1) goes through the kernels of its large matrices,
/// 900 instructions for 3 × 3 where this takes 100.
template <int R, class T>
Mat<R, R, T> inverse_of_positive(const Mat<R, R, T>& S) {
  Mat<R, R, T> K = Mat<R, R, T>::Zero();  // L⁻¹, row by row as L's rows are found
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
  return K.transpose() * K;
}

}  // namespace delassus
