/// The LU factorization of a dense matrix whose size changes from one to the next.
#pragma once

#include <delassus/core/array.hpp>
#include <delassus/core/cmath.hpp>
#include <delassus/core/index.hpp>

#include <cstddef>
#include <span>
#include <utility>

namespace delassus {

/// P A = L U with room that is kept, for systems that change their size from one to the next: column by
/// column, each less its share of the columns before, the largest entry that is left being its pivot.
template <class Real>
class BasicDenseElimination {
 public:
  /// A ← 0, n × n; nothing is allocated below the largest n so far.
  void resize(Index n) {
    n_ = n;
    A_.assign(std::size_t(n) * n, 0);
    swap_.resize(n);
  }
  Real& at(Index row, Index column) { return A_[std::size_t(column) * n_ + row]; }
  Index size() const { return n_; }

  /// False when a pivot is zero or not finite.
  bool factor() {
    for (Index j = 0; j < n_; ++j) {
      Real* const c = &at(0, j);
      for (Index k = 0; k < j; ++k) std::swap(c[k], c[swap_[k]]);
      for (Index k = 0; k < j; ++k) subtract(c[k], &at(0, k), c, k + 1);
      Index pivot = j;
      for (Index i = j + 1; i < n_; ++i)
        if (std::abs(c[i]) > std::abs(c[pivot])) pivot = i;
      const Real size = std::abs(c[pivot]);
      if (!(size > 0) || !std::isfinite(size)) return false;
      swap_[j] = pivot;
      if (pivot != j)
        for (Index k = 0; k <= j; ++k) std::swap(at(j, k), at(pivot, k));
      const Real over = 1 / c[j];
      for (Index i = j + 1; i < n_; ++i) c[i] *= over;
    }
    return true;
  }

  /// x ← A⁻¹ x.
  void solve(std::span<Real> x) const {
    for (Index k = 0; k < n_; ++k) std::swap(x[k], x[swap_[k]]);
    for (Index k = 0; k < n_; ++k) subtract(x[k], column(k), x.data(), k + 1);
    for (Index k = n_; k-- > 0;) {
      const Real* const c = column(k);
      x[k] /= c[k];
      for (Index i = 0; i < k; ++i) x[i] -= c[i] * x[k];
    }
  }

 private:
  const Real* column(Index j) const { return &A_[std::size_t(j) * n_]; }
  /// y_i ← y_i − share c_i for i = first … n − 1.
  void subtract(Real share, const Real* c, Real* y, Index first) const {
    if (share == 0) return;
    for (Index i = first; i < n_; ++i) y[i] -= share * c[i];
  }

  Index n_ = 0;
  Array<Real> A_;
  Array<Index> swap_;
};

using DenseElimination = BasicDenseElimination<double>;

}  // namespace delassus
