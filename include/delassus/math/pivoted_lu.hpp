/// The LU factorization of one small matrix, with row pivots.
#pragma once

#include <delassus/math/linear.hpp>

#include <array>
#include <cmath>
#include <utility>

namespace delassus {

/// P A = L U, w × w, L unit lower: Gaussian elimination, the largest entry of a column being its pivot. Fixed
/// trip counts.
template <int w, class T>
class PivotedLu {
 public:
  /// False when a pivot is zero or not finite.
  bool factor(const Mat<w, w, T>& A) {
    lu_ = A;
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
      for (int k = 0; k < w; ++k) std::swap(x(k, c), x(swap_[k], c));
      for (int k = 0; k < w; ++k)
        for (int i = k + 1; i < w; ++i) x(i, c) -= lu_(i, k) * x(k, c);
      for (int k = w; k-- > 0;) {
        x(k, c) *= over_[k];
        for (int i = 0; i < k; ++i) x(i, c) -= lu_(i, k) * x(k, c);
      }
    }
  }

  /// X ← X A⁻ᵀ for a matrix X of any height: column(k), k < w, are its columns, to be written to.
  void solve_rows(const auto& column) const {
    for (int k = 0; k < w; ++k)
      if (swap_[k] != k) column(k).swap(column(swap_[k]));
    for (int k = 0; k < w; ++k)
      for (int i = k + 1; i < w; ++i) column(i) -= lu_(i, k) * column(k);
    for (int k = w; k-- > 0;) {
      column(k) *= over_[k];
      for (int i = 0; i < k; ++i) column(i) -= lu_(i, k) * column(k);
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
  std::array<T, w> over_;  ///< 1 / U_kk
  std::array<int, w> swap_;
};

}  // namespace delassus
