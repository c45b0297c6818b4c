/// One row of a block-sparse matrix times a vector of blocks.
#pragma once

#include <delassus/core/index.hpp>
#include <delassus/math/linear.hpp>
#include <delassus/math/two_lanes.hpp>

#include <cstddef>
#include <cstring>

namespace delassus::inner {

/// r += A x of one block R × columns by columns; the product is summed first, from left to right, in double.
template <int R, class T, class X>
[[gnu::always_inline]] inline void add_block(double* r, const T* A, const X* x, int columns) {
  double product[R];
  DELASSUS_UNROLL
  for (int i = 0; i < R; ++i) product[i] = double(A[i]) * double(x[0]);
  for (int k = 1; k < columns; ++k) {
    DELASSUS_UNROLL
    for (int i = 0; i < R; ++i) product[i] += double(A[i + R * k]) * double(x[k]);
  }
  DELASSUS_UNROLL
  for (int i = 0; i < R; ++i) r[i] += product[i];
}

/// The same of a block as wide as high.
template <int R, class T>
[[gnu::always_inline]] inline void add_square_block(double* r, const T* A, const T* x) {
  double product[R];
  DELASSUS_UNROLL
  for (int i = 0; i < R; ++i) product[i] = double(A[i]) * double(x[0]);
  DELASSUS_UNROLL
  for (int k = 1; k < R; ++k) {
    DELASSUS_UNROLL
    for (int i = 0; i < R; ++i) product[i] += double(A[i + R * k]) * double(x[k]);
  }
  DELASSUS_UNROLL
  for (int i = 0; i < R; ++i) r[i] += product[i];
}

#ifdef __AVX__
/// Where four numbers fit in a register, a column of the block at a time. The fourth number of the first two
/// is the next column's. The third column is read from the entry before it, so that nothing outside of the block
/// is touched.
typedef double Four __attribute__((vector_size(4 * sizeof(double))));

struct ColumnSums {
  Four first{}, second{}, third{};

  void add(const double* w, const double* y) {
    Four a, b, c;
    std::memcpy(&a, w, sizeof a);
    std::memcpy(&b, w + 3, sizeof b);
    std::memcpy(&c, w + 5, sizeof c);
    first += a * y[0];
    second += b * y[1];
    third += c * y[2];
  }
};

/// r += Σ_e W_e x_{column(e)} of blocks 3 × 3.
[[gnu::always_inline]] inline void add_row_of_three(double* r, Index count, const double* W, const Index* column,
                                                    const double* x) {
  ColumnSums even, odd;
  Index e = 0;
  for (; e + 1 < count; e += 2) {
    even.add(W + 9 * std::ptrdiff_t(e), x + 3 * std::ptrdiff_t(column[e]));
    odd.add(W + 9 * std::ptrdiff_t(e + 1), x + 3 * std::ptrdiff_t(column[e + 1]));
  }
  if (e < count) even.add(W + 9 * std::ptrdiff_t(e), x + 3 * std::ptrdiff_t(column[e]));
  for (int k = 0; k < 3; ++k)
    r[k] += (even.first[k] + odd.first[k]) + (even.second[k] + odd.second[k]) +
            (even.third[k + 1] + odd.third[k + 1]);
}
#else
/// r += Σ_e W_e x_{column(e)} of the 3 × 3 blocks of contacts, two numbers at a time as they lie, column by column:
///
///   (w₀₀ w₁₀) x₀,  (w₂₀ w₀₁) (x₀ x₁),  (w₁₁ w₂₁) x₁,  (w₀₂ w₁₂) x₂,  w₂₂ x₂,
///
/// each into a sum of its own, so that no addition waits for the one before it. Of arrays and loops compilers made
/// nine scalar products of a 3 × 3 block.
[[gnu::always_inline]] inline void add_row_of_three(double* r, Index count, const double* W, const Index* column,
                                                    const double* x) {
  TwoLanes first{}, across{}, second{}, third{};
  double last = 0;
  for (Index e = 0; e < count; ++e) {
    const double *w = W + 9 * std::ptrdiff_t(e), *y = x + 3 * std::ptrdiff_t(column[e]);
    first += two_lanes_at(w) * y[0];
    across += two_lanes_at(w + 2) * two_lanes_at(y);
    second += two_lanes_at(w + 4) * y[1];
    third += two_lanes_at(w + 6) * y[2];
    last += w[8] * y[2];
  }
  r[0] += (first[0] + across[1]) + third[0];
  r[1] += (first[1] + second[0]) + third[1];
  r[2] += (across[0] + second[1]) + last;
}
#endif

/// r += Σ_e W_e x_{column(e)}, e = first … last − 1: blocks R × R, in double whatever T is.
template <int R, class T>
[[gnu::always_inline]] inline void add_row(double* r, Index first, Index last, const T* W, const Index* column, const T* x) {
  if constexpr (R == 3 && sizeof(T) == sizeof(double)) {
    add_row_of_three(r, last - first, W + 9 * std::ptrdiff_t(first), column + first, x);
  } else {
    for (Index e = first; e < last; ++e) add_square_block<R>(r, W + std::ptrdiff_t(R * R) * e, x + std::ptrdiff_t(R) * column[e]);
  }
}
/// The same of blocks R × columns.
template <int R, class T>
[[gnu::always_inline]] inline void add_wide_row(double* r, Index first, Index last, const T* W, const Index* column, const T* x, int columns) {
  W += std::ptrdiff_t(R * columns) * first;
  for (Index e = first; e < last; ++e, W += R * columns) add_block<R>(r, W, x + std::ptrdiff_t(columns) * column[e], columns);
}

/// Σ_e (W_e x_{column(e)})₀ of blocks 3 × 3: the first of those rows alone, at a third of the products. Entries take turns with
/// two sums, since an addition takes as long as the loads of two.
template <class T>
[[gnu::always_inline]] inline double first_of_row(Index first, Index last, const T* W, const Index* column, const T* x) {
  double even[3] = {}, odd[3] = {};
  const T *w = W + 9 * std::ptrdiff_t(first), *end = W + 9 * std::ptrdiff_t(last);
  column += first;
  for (; end - w > 9; w += 18, column += 2)
    for (int k = 0; k < 3; ++k) {
      even[k] += double(w[3 * k]) * double(x[3 * std::ptrdiff_t(column[0]) + k]);
      odd[k] += double(w[9 + 3 * k]) * double(x[3 * std::ptrdiff_t(column[1]) + k]);
    }
  if (w != end)
    for (int k = 0; k < 3; ++k) even[k] += double(w[3 * k]) * double(x[3 * std::ptrdiff_t(*column) + k]);
  double all = 0;
  for (int k = 0; k < 3; ++k) all += even[k] + odd[k];
  return all;
}
/// The same of blocks 3 × columns.
template <class T>
double first_of_wide_row(Index first, Index last, const T* W, const Index* column, const T* x, int columns) {
  double all = 0;
  for (Index e = first; e < last; ++e)
    for (int k = 0; k < columns; ++k)
      all += double(W[3 * (std::ptrdiff_t(columns) * e + k)]) * double(x[std::ptrdiff_t(columns) * column[e] + k]);
  return all;
}

}  // namespace delassus::inner
