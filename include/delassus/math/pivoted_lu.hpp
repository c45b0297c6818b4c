/// The LU factorization of one small matrix, with row pivots.
#pragma once

#include <delassus/core/cmath.hpp>
#include <delassus/core/fixed_array.hpp>
#include <delassus/core/index.hpp>
#include <delassus/math/linear.hpp>
#include <delassus/math/long_vectors.hpp>

#include <utility>

namespace delassus {

/// P A = L U, w × w, L unit lower: Gaussian elimination, the largest entry of a column being its pivot. Fixed
/// trip counts.
template <int w, class T>
class PivotedLu {
 public:
  /// False when a pivot is zero or not finite.
  bool factor(const Mat<w, w, T>& A) { return eliminate(A, w); }
  /// Of the first `used` rows and columns, behind which A is the identity; `solve` and `solve_rows` are told so too.
  bool factor(const Mat<w, w, T>& A, int used) { return eliminate(A, used); }

  /// X ← A⁻¹ X, the first `columns`.
  void solve(Mat<w, w, T>& X, int used, int columns) const {
    for (int c = 0; c < columns; ++c) {
      T* const x = X.data() + w * c;
      for (int k = 0; k < used; ++k) std::swap(x[k], x[swap_[k]]);
      for (int k = 0; k < used; ++k)
        for (int i = k + 1; i < used; ++i) x[i] -= lu_(i, k) * x[k];
      for (int k = used; k-- > 0;) {
        x[k] *= over_[k];
        for (int i = 0; i < k; ++i) x[i] -= lu_(i, k) * x[k];
      }
    }
  }

  /// x ← A⁻¹ x, column by column.
  template <int C>
  void solve(Mat<w, C, T>& x) const {
    for (int c = 0; c < C; ++c) {
      T* const to = x.data() + w * c;
      for (int k = 0; k < w; ++k) std::swap(to[k], to[swap_[k]]);
      T y[w];  // in registers: x may be L or U for all that a compiler knows
      DELASSUS_UNROLL
      for (int k = 0; k < w; ++k) y[k] = to[k];
      DELASSUS_UNROLL
      for (int k = 0; k < w; ++k) {
        DELASSUS_UNROLL
        for (int i = k + 1; i < w; ++i) y[i] -= lu_.data()[i + w * k] * y[k];
      }
      DELASSUS_UNROLL
      for (int k = w - 1; k >= 0; --k) {
        y[k] *= over_[k];
        DELASSUS_UNROLL
        for (int i = 0; i < k; ++i) y[i] -= lu_.data()[i + w * k] * y[k];
      }
      DELASSUS_UNROLL
      for (int k = 0; k < w; ++k) to[k] = y[k];
    }
  }

  /// X ← X A⁻ᵀ for a matrix X of `height` rows: column(k), k < used, points at its columns. Behind `used` A is
  /// the identity.
  void solve_rows(const auto& column, Index height, int used = w) const {
    for (int k = 0; k < used; ++k)
      if (swap_[k] != k)
        for (Index r = 0; r < height; ++r) std::swap(column(k)[r], column(swap_[k])[r]);
    T less[w];
    const std::ptrdiff_t stride = used > 1 ? column(1) - column(0) : 0;
    for (int i = 1; i < used; ++i) {
      for (int k = 0; k < i; ++k) less[k] = -lu_(i, k);
      add_multiples(less, i, column(0), stride, column(i), height);
    }
    for (int i = used; i-- > 0;) {
      for (int k = used - 1; k > i; --k) less[used - 1 - k] = -lu_(i, k);
      add_multiples(less, used - 1 - i, column(used - 1), -stride, column(i), height);
      scale(over_[i], column(i), height);
    }
  }

  /// Whether det A < 0, of the last A that was factored.
  bool is_negative() const {
    bool is = false;
    for (int k = 0; k < w; ++k) is ^= (lu_(k, k) < T(0)) ^ (swap_[k] != k);
    return is;
  }

 private:
  [[gnu::always_inline]] bool eliminate(const Mat<w, w, T>& A, int used) {
    assign(lu_, A);
    for (int k = 0; k < used; ++k) {
      int pivot = k;
      for (int i = k + 1; i < used; ++i)
        if (std::abs(lu_(i, k)) > std::abs(lu_(pivot, k))) pivot = i;
      const T size = std::abs(lu_(pivot, k));
      if (!(size > T(0)) || !std::isfinite(size)) return false;
      swap_[k] = pivot;
      if (pivot != k)
        for (int j = 0; j < used; ++j) std::swap(lu_(k, j), lu_(pivot, j));
      over_[k] = T(1) / lu_(k, k);
      for (int i = k + 1; i < used; ++i) lu_(i, k) *= over_[k];
      for (int j = k + 1; j < used; ++j) {
        const T u = lu_(k, j);
        for (int i = k + 1; i < used; ++i) lu_(i, j) -= lu_(i, k) * u;
      }
    }
    for (int k = used; k < w; ++k) swap_[k] = k, over_[k] = T(1);
    return true;
  }

  Mat<w, w, T> lu_;
  FixedArray<T, w> over_;  ///< 1 / U_kk
  FixedArray<int, w> swap_;
};

}  // namespace delassus
