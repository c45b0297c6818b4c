/// Cholesky factorization of a block-tridiagonal matrix: each block meets its two neighbours alone.
#pragma once

#include <delassus/core/array.hpp>
#include <delassus/core/cmath.hpp>
#include <delassus/core/index.hpp>
#include <delassus/core/sort.hpp>
#include <delassus/math/linear.hpp>

#include <algorithm>
#include <cstddef>
#include <span>
#include <utility>

namespace delassus {

/// A = L Lᵀ with w × w blocks, taken as they come: a chain has no fill. L_i on the diagonal, E_i below it:
///
///   L_i L_iᵀ = A_ii − E_{i−1} E_{i−1}ᵀ,   E_i = A_{i+1,i} L_i⁻ᵀ.
///
/// Time and memory grow with the number of blocks. `factor`, `solve` and a warm `compliance` do not allocate.
/// Blocks are column-major and worked on by plain loops.
template <int w, class T>
class BlockChain {
 public:
  using Block = Mat<w, w, T>;

  /// A chain of this many blocks. Pairs say nothing new, as each must be of neighbours.
  void analyse(Index blocks, std::span<const std::pair<Index, Index>> = {}) {
    diagonal_.assign(blocks, Block::Zero());
    below_.assign(std::max<Index>(blocks - 1, 0), Block::Zero());
  }
  Index blocks() const { return Index(diagonal_.size()); }

  void set_zero() {
    for (Block& b : diagonal_) b.setZero();
    for (Block& b : below_) b.setZero();
  }
  /// A_ii += block.
  void add_diagonal(Index i, const Block& block) { add<false>(diagonal_[i], block); }
  /// A_ij += block and A_ji += blockᵀ, i and j neighbours.
  void add_pair(Index i, Index j, const Block& block) {
    if (i > j)
      add<false>(below_[j], block);
    else
      add<true>(below_[i], block);
  }

  /// Replaces A by its factor; false when a pivot is not positive.
  bool factor() {
    for (Index i = 0; i < blocks(); ++i) {
      T* L = diagonal_[i].data();
      if (i > 0) subtract_square(L, below_[i - 1].data());
      if (!factor_block(L)) return false;
      if (i + 1 < blocks()) solve_right(below_[i].data(), L);
    }
    return true;
  }

  /// x ← A⁻¹ x.
  void solve(std::span<Vec<w, T>> x) const {
    for (Index i = 0; i < blocks(); ++i) {
      if (i > 0) subtract_times(x[i].data(), below_[i - 1].data(), x[i - 1].data());
      forward(diagonal_[i].data(), x[i].data());
    }
    for (Index i = blocks(); i-- > 0;) {
      if (i + 1 < blocks()) subtract_transposed_times(x[i].data(), below_[i].data(), x[i + 1].data());
      backward(diagonal_[i].data(), x[i].data());
    }
  }

  /// C, (w n) × (w n) numbers by columns: the rows and columns of A⁻¹ of n blocks, each named once. With
  /// U_i = L_i⁻ᵀ E_iᵀ the blocks of A⁻¹ follow from the last to the first:
  ///
  ///   C_ij = −U_i C_{i+1,j} for j > i,   C_ii = (L_i L_iᵀ)⁻¹ + U_i C_{i+1,i+1} U_iᵀ,
  ///
  /// and of the columns only the wanted ones are carried along.
  void compliance(std::span<const Index> nodes, std::span<T> C) const {
    const std::size_t rows = w * nodes.size();
    order_.clear();
    for (Index k = 0; k < Index(nodes.size()); ++k) order_.emplace_back(nodes[k], k);
    inner::sort(order_);
    columns_.resize(nodes.size());
    std::size_t done = order_.size();  // order_[done …] have a column
    Block last;
    for (Index i = blocks(); i-- > 0 && done > 0;) {
      Block next = inverse_of(diagonal_[i].data());
      if (i + 1 < blocks()) {
        const Block U = carry_of(i);
        for (std::size_t k = done; k < order_.size(); ++k) columns_[k] = negated_product(U, columns_[k]);
        const Block negative = negated_product(U, last);
        for (int c = 0; c < w; ++c)
          for (int k = 0; k < w; ++k)
            for (int r = 0; r < w; ++r) next(r, c) -= negative(r, k) * U(c, k);
      }
      last = next;
      if (order_[done - 1].first != i) continue;
      columns_[--done] = last;
      const std::size_t a = w * order_[done].second;
      for (std::size_t k = done; k < order_.size(); ++k) {
        const std::size_t b = w * order_[k].second;
        for (int c = 0; c < w; ++c)
          for (int r = 0; r < w; ++r)
            C[a + r + rows * (b + c)] = C[b + c + rows * (a + r)] = columns_[k](r, c);
      }
    }
  }

 private:
  template <bool is_transposed>
  static void add(Block& to, const Block& block) {
    for (int c = 0; c < w; ++c)
      for (int r = 0; r < w; ++r) to(r, c) += is_transposed ? block(c, r) : block(r, c);
  }
  /// A −= E Eᵀ, lower triangle.
  static void subtract_square(T* A, const T* E) {
    for (int k = 0; k < w; ++k)
      for (int c = 0; c < w; ++c)
        for (int r = c; r < w; ++r) A[r + w * c] -= E[r + w * k] * E[c + w * k];
  }
  /// The lower triangle of A becomes its factor, the upper one is not looked at.
  static bool factor_block(T* A) {
    for (int c = 0; c < w; ++c) {
      if (!(A[c + w * c] > T(0))) return false;
      const T pivot = A[c + w * c] = std::sqrt(A[c + w * c]);
      for (int r = c + 1; r < w; ++r) A[r + w * c] /= pivot;
      for (int k = c + 1; k < w; ++k)
        for (int r = k; r < w; ++r) A[r + w * k] -= A[r + w * c] * A[k + w * c];
    }
    return true;
  }
  /// X ← X L⁻ᵀ.
  static void solve_right(T* X, const T* L) {
    for (int c = 0; c < w; ++c) {
      for (int r = 0; r < w; ++r) X[r + w * c] /= L[c + w * c];
      for (int k = c + 1; k < w; ++k)
        for (int r = 0; r < w; ++r) X[r + w * k] -= X[r + w * c] * L[k + w * c];
    }
  }
  /// x ← L⁻¹ x.
  static void forward(const T* L, T* x) {
    for (int c = 0; c < w; ++c) {
      x[c] /= L[c + w * c];
      for (int r = c + 1; r < w; ++r) x[r] -= L[r + w * c] * x[c];
    }
  }
  /// x ← L⁻ᵀ x.
  static void backward(const T* L, T* x) {
    for (int c = w; c-- > 0;) {
      for (int r = c + 1; r < w; ++r) x[c] -= L[r + w * c] * x[r];
      x[c] /= L[c + w * c];
    }
  }
  static void subtract_times(T* y, const T* E, const T* x) {
    for (int c = 0; c < w; ++c)
      for (int r = 0; r < w; ++r) y[r] -= E[r + w * c] * x[c];
  }
  static void subtract_transposed_times(T* y, const T* E, const T* x) {
    for (int c = 0; c < w; ++c)
      for (int r = 0; r < w; ++r) y[c] -= E[r + w * c] * x[r];
  }
  static Block negated_product(const Block& A, const Block& B) {
    Block C = Block::Zero();
    for (int c = 0; c < w; ++c)
      for (int k = 0; k < w; ++k)
        for (int r = 0; r < w; ++r) C(r, c) -= A(r, k) * B(k, c);
    return C;
  }
  /// (L Lᵀ)⁻¹.
  static Block inverse_of(const T* L) {
    Block inverse = Block::Identity();
    for (int c = 0; c < w; ++c) {
      forward(L, inverse.data() + w * c);
      backward(L, inverse.data() + w * c);
    }
    return inverse;
  }
  /// U_i.
  Block carry_of(Index i) const {
    Block U = Block::Zero();
    add<true>(U, below_[i]);
    for (int c = 0; c < w; ++c) backward(diagonal_[i].data(), U.data() + w * c);
    return U;
  }

  Array<Block> diagonal_, below_;
  mutable Array<std::pair<Index, Index>> order_;  ///< (node, number), ascending
  mutable Array<Block> columns_;
};

}  // namespace delassus
