/// Multifrontal Cholesky factorization of a sparse symmetric positive definite matrix of small square blocks.
#pragma once

#include <delassus/core/array.hpp>
#include <delassus/linear/inner/dense_kernel.hpp>
#include <delassus/linear/inner/front_solve.hpp>
#include <delassus/linear/inner/front_triangle.hpp>
#include <delassus/linear/inner/front_workers.hpp>
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
    const auto part_of = [&](Index s) { return L_.part(plan_, s); };
    for (Index s = 0; s < fronts(); ++s)
      if (!L_.factor_front(plan_, s, diagonal(), below(), part_of, kernel_)) return false;
    return true;
  }

  /// x ← A⁻¹ x.
  void solve(std::span<Vec<w, T>> x) const {
    enter(x);
    gather_.resize(std::size_t(plan_.layout.most_rows));
    T* const y = y_.data();
    T* const gather = gather_.data();
    for (Index s = 0; s < fronts(); ++s) {
      const Supernode& front = plan_.supernode(s);
      inner::solve_forward<w, T>(front, columns_of(s), y, gather);
      inner::add_rows<w>(front, front.width, Index(front.rows.size()), gather + w * front.width, y);
    }
    for (Index s = fronts(); s-- > 0;)
      inner::solve_backward<w, T>(plan_.supernode(s), columns_of(s), y, gather);
    leave(x);
  }

  /// The rows and columns of A⁻¹ of some nodes, each named once: C is (w n) × (w n) by columns. See
  /// `NodeCompliance`.
  void compliance(std::span<const Index> nodes, std::span<T> C) const { compliance_.find(*this, nodes, C); }

  // --- the same by several workers, with the same bits ---

  /// What they keep of one factor, and what each keeps for all factors.
  using Workers = inner::FrontWorkers<w, T>;
  using Dense = inner::DenseWorkers<T>;

  /// After `analyse`, and before `factor` and `solve`.
  void prepare(Workers& by, Dense& dense, Index workers) const {
    by.analyse(plan_, workers);
    dense.prepare(workers, plan_.layout.most_rows, std::size_t(plan_.layout.most_rows));
  }
  /// E is an `Execution` with as many workers, and so below.
  template <class E>
  bool factor(Workers& by, Dense& dense, const E& execution) {
    return by.factor(plan_, L_, diagonal(), below(), dense, execution);
  }
  template <class E>
  void solve(std::span<Vec<w, T>> x, Workers& by, Dense& dense, const E& execution) const {
    enter(x);
    by.solve(plan_, L_, y_.data(), dense, execution);
    leave(x);
  }
  template <class E>
  void compliance(std::span<const Index> nodes, std::span<T> C, Dense& dense, const E& execution) const {
    compliance_.find(*this, nodes, C, dense, execution);
  }

  const SupernodalPattern& pattern() const { return plan_.pattern; }
  /// The columns of L of a supernode, with its rows.
  inner::Columns<const T> columns_of(Index s) const { return L_.columns(plan_, s); }

 private:
  Index fronts() const { return plan_.fronts(); }
  /// A's blocks, of a place and of an entry below the diagonal.
  auto diagonal() const {
    return [this](Index place) -> const Block& { return A_[place]; };
  }
  auto below() const {
    return [this](Index entry) -> const Block& { return A_[blocks() + entry]; };
  }

  /// From the order of the nodes to that of elimination, and back.
  [[gnu::always_inline]] void enter(std::span<const Vec<w, T>> x) const {
    y_.resize(std::size_t(w) * blocks());
    for (Index i = 0; i < blocks(); ++i)
      for (int c = 0; c < w; ++c) y_[w * pattern().place(i) + c] = x[i][c];
  }
  [[gnu::always_inline]] void leave(std::span<Vec<w, T>> x) const {
    for (Index i = 0; i < blocks(); ++i)
      for (int c = 0; c < w; ++c) x[i][c] = y_[w * pattern().place(i) + c];
  }

  inner::FrontPlan plan_;
  Array<Block> A_;  ///< the diagonal blocks by place, then those below by entry
  inner::FrontTriangle<w, T> L_;
  inner::DenseKernel<T> kernel_;
  mutable NodeCompliance<w, T> compliance_;
  mutable Array<T> y_, gather_;
};

}  // namespace delassus
