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
  bool factor(const Mat<w, w, T>& A) {
    assign(lu_, A);
    for (int k = 0; k < w; ++k) {
      int pivot = k;
      for (int i = k + 1; i < w; ++i)
        if (std::abs(lu_(i, k)) > std::abs(lu_(pivot, k))) pivot = i;
      const T size = std::abs(lu_(pivot, k));
      if (!(size > T(0)) || !std::isfinite(size)) return false;
      swap_[k] = pivot;
      if (pivot != k)
        for (int j = 0; j < w; ++j) std::swap(lu_(k, j), lu_(pivot, j));
      over_[k] = T(1) / lu_(k, k);
      for (int i = k + 1; i < w; ++i) lu_(i, k) *= over_[k];
      for (int j = k + 1; j < w; ++j) {
        const T u = lu_(k, j);
        for (int i = k + 1; i < w; ++i) lu_(i, j) -= lu_(i, k) * u;
      }
    }
    return true;
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

  /// X ← X A⁻ᵀ for a matrix X of `height` rows: column(k), k < w, points at its columns.
  void solve_rows(const auto& column, Index height) const {
    for (int k = 0; k < w; ++k)
      if (swap_[k] != k)
        for (Index r = 0; r < height; ++r) std::swap(column(k)[r], column(swap_[k])[r]);
    for (int k = 0; k < w; ++k)
      for (int i = k + 1; i < w; ++i) add_multiple<T>(-lu_(i, k), column(k), column(i), height);
    for (int k = w; k-- > 0;) {
      T* const x = column(k);
      for (Index r = 0; r < height; ++r) x[r] *= over_[k];
      for (int i = 0; i < k; ++i) add_multiple<T>(-lu_(i, k), x, column(i), height);
    }
  }

  /// Whether det A < 0, of the last A that was factored.
  bool is_negative() const {
    bool is = false;
    for (int k = 0; k < w; ++k) is ^= (lu_(k, k) < T(0)) ^ (swap_[k] != k);
    return is;
  }

 private:
  Mat<w, w, T> lu_;
  FixedArray<T, w> over_;  ///< 1 / U_kk
  FixedArray<int, w> swap_;
};

}  // namespace delassus
