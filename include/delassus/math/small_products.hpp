/// Products of small matrices of any size, added where they belong.
#pragma once

#include <delassus/math/linear.hpp>

namespace delassus {

// Eigen makes a type of every product, and dozens of functions to compile for each pair of sizes; these are
// loops with fixed trip counts over columns. `eager.hpp` has the like for 3-vectors.

/// C += s A B. A column of C stays in registers, since C may be A or B for all that a compiler knows.
template <int r, int k, int c, class T>
inline void add_product(const Mat<r, k, T>& A, const Mat<k, c, T>& B, Mat<r, c, T>& C, T s = T(1)) {
  for (int column = 0; column < c; ++column) {
    T* const to = C.data() + r * column;
    T sum[r];
    DELASSUS_UNROLL
    for (int i = 0; i < r; ++i) sum[i] = to[i];
    DELASSUS_UNROLL
    for (int j = 0; j < k; ++j) {
      const T b = s * B.data()[k * column + j];
      DELASSUS_UNROLL
      for (int i = 0; i < r; ++i) sum[i] += A.data()[r * j + i] * b;
    }
    DELASSUS_UNROLL
    for (int i = 0; i < r; ++i) to[i] = sum[i];
  }
}

/// The same of numbers by columns, of sizes that are known at run time: r × k times k × c.
template <class T>
[[gnu::always_inline]] inline void add_product(int r, int k, int c, const T* A, const T* B, T* C) {
  for (int column = 0; column < c; ++column)
    for (int j = 0; j < k; ++j) {
      const T b = B[k * column + j];
      for (int i = 0; i < r; ++i) C[r * column + i] += A[r * j + i] * b;
    }
}

/// (A B)_ij alone.
template <int r, int k, int c, class T>
inline T row_times_column(const Mat<r, k, T>& A, int i, const Mat<k, c, T>& B, int j) {
  T sum = 0;
  for (int n = 0; n < k; ++n) sum += A.data()[i + r * n] * B.data()[n + k * j];
  return sum;
}

template <int r, int c, class T>
inline Vec<r, T> column(const Mat<r, c, T>& A, int j) {
  Vec<r, T> x;
  for (int i = 0; i < r; ++i) x[i] = A.data()[i + r * j];
  return x;
}

}  // namespace delassus
