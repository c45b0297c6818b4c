/// Multifrontal Cholesky factorization of a sparse symmetric positive definite matrix of small square blocks.
#pragma once

#include <delassus/core/array.hpp>
#include <delassus/linear/inner/dense_kernel.hpp>
#include <delassus/linear/inner/front_triangle.hpp>
#include <delassus/linear/node_compliance.hpp>
#include <delassus/math/long_vectors.hpp>

#include <algorithm>
#include <cstddef>
#include <span>
#include <utility>

namespace delassus {

/// P A Pᵀ = L Lᵀ with w × w blocks, P by nested dissection. Every supernode is a dense front: its entries of
/// A plus what its children leave, its columns factored, the rest left to its parent. The pattern is analysed
/// once; from the second time on `factor`, `solve` and `compliance` do not allocate. For some hundred nodes or
/// more; below that `BlockCholesky` does. Source: I. S. Duff, J. K. Reid, "The multifrontal solution of
/// indefinite sparse symmetric linear equations".
template <int w, class T>
class MultifrontalCholesky {
 public:
  using Block = Mat<w, w, T>;

  /// Pattern of the lower triangle: all diagonal blocks and the pairs (i, j), i ≠ j, in any order, repeats
  /// allowed. `positions` is empty or one point a block, m; they make a better order.
  void analyse(Index blocks, std::span<const std::pair<Index, Index>> pairs,
               std::span<const Vec3> positions = {}) {
    plan_.analyse(w, blocks, pairs, positions);
    A_.resize(blocks + plan_.entries.row.size());
  }

  Index blocks() const { return plan_.blocks(); }
  /// Numbers stored for L.
  std::size_t size() const { return plan_.layout.factor_size; }

  void set_zero() {
    for (Block& b : A_) b.setZero();
  }
  /// A_ii += block.
  void add_diagonal(Index i, const Block& block) { A_[pattern().place(i)] += block; }
  /// A_ij += block and A_ji += blockᵀ, i ≠ j.
  void add_pair(Index i, Index j, const Block& block) {
    const Index row = pattern().place(i), column = pattern().place(j);
    if (row > column)
      A_[blocks() + plan_.entries.find(row, column)] += block;
    else
      A_[blocks() + plan_.entries.find(column, row)] += block.transpose();
  }

  /// Makes the factor of A; false when A is not positive definite or not finite: then nothing may be solved.
  bool factor() {
    L_.resize(plan_);
    for (Index s = 0; s < fronts(); ++s)
      if (!factor_front(s)) return false;
    return true;
  }

  /// x ← A⁻¹ x.
  void solve(std::span<Vec<w, T>> x) const {
    y_.resize(std::size_t(w) * blocks());
    for (Index i = 0; i < blocks(); ++i) for (int c = 0; c < w; ++c) y_[w * pattern().place(i) + c] = x[i][c];
    for (Index s = 0; s < fronts(); ++s) forward(s);
    for (Index s = fronts(); s-- > 0;) backward(s);
    for (Index i = 0; i < blocks(); ++i) for (int c = 0; c < w; ++c) x[i][c] = y_[w * pattern().place(i) + c];
  }

  /// The rows and columns of A⁻¹ of some nodes, each named once: C is (w n) × (w n) by columns. See
  /// `NodeCompliance`.
  void compliance(std::span<const Index> nodes, std::span<T> C) const { compliance_.find(*this, nodes, C); }

  const SupernodalPattern& pattern() const { return plan_.pattern; }
  /// The columns of L of a supernode, with its rows.
  inner::Columns<const T> columns_of(Index s) const { return L_.columns(plan_, s); }

 private:
  template <class U>
  using Columns = inner::Columns<U>;

  Index fronts() const { return plan_.fronts(); }

  bool factor_front(Index s) {
    const Index height = w * Index(plan_.supernode(s).rows.size()), width = w * plan_.supernode(s).width,
                below = height - width;
    const Columns<T> L = L_.columns(plan_, s);
    L_.open(
        plan_, s, [&](Index place) -> const Block& { return A_[place]; },
        [&](Index entry) -> const Block& { return A_[blocks() + entry]; });
    if (!kernel_.factor(L, height, width)) return false;
    const Columns<const T> L21{L.at(width, 0), L.stride};
    kernel_.negated_product(L_.part(plan_, s), L21, L21, below, below, width, true);
    L_.pass_on(plan_, s);
    return true;
  }

  /// y ← L⁻¹ y, the share of one supernode; rows are gathered so that columns of L are read from end to end.
  void forward(Index s) const {
    const Supernode& x = plan_.supernode(s);
    const Index height = w * Index(x.rows.size()), width = w * x.width;
    const Columns<const T> L = columns_of(s);
    gather_.assign(height, T(0));
    std::copy_n(&y_[w * x.first], width, gather_.begin());
    for (Index j = 0; j < width; ++j) {
      const T y = gather_[j] /= *L.at(j, j);
      add_multiple<T>(-y, L.at(j, j) + 1, gather_.data() + j + 1, height - j - 1);
    }
    std::copy_n(gather_.begin(), width, &y_[w * x.first]);
    for (Index k = x.width; k < Index(x.rows.size()); ++k)
      for (int c = 0; c < w; ++c) y_[w * x.rows[k] + c] += gather_[w * k + c];
  }
  /// y ← L⁻ᵀ y.
  void backward(Index s) const {
    const Supernode& x = plan_.supernode(s);
    const Index height = w * Index(x.rows.size());
    const Columns<const T> L = columns_of(s);
    gather_.resize(height);
    for (Index k = 0; k < Index(x.rows.size()); ++k)
      for (int c = 0; c < w; ++c) gather_[w * k + c] = y_[w * x.rows[k] + c];
    for (Index j = w * x.width; j-- > 0;) {
      const Index rest = height - j - 1;
      const T below = sum_of_products<T>(L.at(j, j) + 1, gather_.data() + j + 1, rest);
      gather_[j] = (gather_[j] - below) / *L.at(j, j);
    }
    std::copy_n(gather_.begin(), w * x.width, &y_[w * x.first]);
  }

  inner::FrontPlan plan_;
  Array<Block> A_;  ///< the diagonal blocks by place, then those below by entry
  inner::FrontTriangle<w, T> L_;
  inner::DenseKernel<T> kernel_;
  mutable NodeCompliance<w, T> compliance_;
  mutable Array<T> y_, gather_;
};

}  // namespace delassus
