/// Sparse Cholesky factorization of a symmetric positive definite matrix of small square blocks.
#pragma once

#include <delassus/core/array.hpp>
#include <delassus/core/index.hpp>
#include <delassus/linear/block_pattern.hpp>
#include <delassus/math/eigen.hpp>
#include <delassus/math/linear.hpp>

#include <span>
#include <utility>

namespace delassus {

/// P A Pᵀ = L Lᵀ with w × w blocks, P by minimum degree. The pattern is analysed once; `factor` and
/// `solve` do not allocate. Right-looking: when a column is done, its outer product is taken from the columns
/// after.
template <int w, class T>
class BlockCholesky {
 public:
  using Block = Mat<w, w, T>;

  /// Pattern of the lower triangle: all diagonal blocks and the pairs (i, j), i ≠ j, in any order, repeats
  /// allowed.
  void analyse(Index blocks, std::span<const std::pair<Index, Index>> pairs) {
    pattern_.analyse(blocks, pairs);
    diagonal_.resize(blocks);
    lower_.resize(pattern_.entries());
    work_.resize(blocks);
  }

  void set_zero() {
    for (Block& b : diagonal_) b.setZero();
    for (Block& b : lower_) b.setZero();
  }
  /// A_ii += block.
  void add_diagonal(Index i, const Block& block) { diagonal_[pattern_.place(i)] += block; }
  /// A_ij += block and A_ji += blockᵀ, i ≠ j.
  void add_pair(Index i, Index j, const Block& block) {
    const Index row = pattern_.place(i), column = pattern_.place(j);
    if (row > column)
      lower_[pattern_.find(row, column)] += block;
    else
      lower_[pattern_.find(column, row)] += block.transpose();
  }

  /// Replaces A by its factor; false when a pivot block is not positive definite.
  bool factor() {
    for (Index j = 0; j < Index(diagonal_.size()); ++j) {
      const Eigen::LLT<Block> pivot(diagonal_[j]);
      if (pivot.info() != Eigen::Success) return false;
      diagonal_[j] = pivot.matrixL();
      const auto L = diagonal_[j].template triangularView<Eigen::Lower>();
      const Index first = pattern_.start(j), last = pattern_.start(j + 1);
      for (Index e = first; e < last; ++e) lower_[e] = L.solve(Block(lower_[e].transpose())).transpose();
      for (Index e = first; e < last; ++e) {
        diagonal_[pattern_.row(e)].noalias() -= lower_[e] * lower_[e].transpose();
        for (Index f = e + 1; f < last; ++f)
          lower_[pattern_.find(pattern_.row(f), pattern_.row(e))].noalias() -=
              lower_[f] * lower_[e].transpose();
      }
    }
    return true;
  }

  /// x ← A⁻¹ x.
  void solve(std::span<Vec<w, T>> x) const {
    const Index n = Index(diagonal_.size());
    for (Index i = 0; i < n; ++i) work_[pattern_.place(i)] = x[i];
    for (Index j = 0; j < n; ++j) {
      diagonal_[j].template triangularView<Eigen::Lower>().solveInPlace(work_[j]);
      for (Index e = pattern_.start(j); e < pattern_.start(j + 1); ++e)
        work_[pattern_.row(e)].noalias() -= lower_[e] * work_[j];
    }
    for (Index j = n; j-- > 0;) {
      for (Index e = pattern_.start(j); e < pattern_.start(j + 1); ++e)
        work_[j].noalias() -= lower_[e].transpose() * work_[pattern_.row(e)];
      diagonal_[j].transpose().template triangularView<Eigen::Upper>().solveInPlace(work_[j]);
    }
    for (Index i = 0; i < n; ++i) x[i] = work_[pattern_.place(i)];
  }

 private:
  BlockPattern pattern_;
  Array<Block> diagonal_, lower_;
  mutable Array<Vec<w, T>> work_;
};

}  // namespace delassus
