/// Multifrontal LU factorization of an unsymmetric matrix of small square blocks whose pattern is symmetric.
#pragma once

#include <delassus/core/array.hpp>
#include <delassus/linear/inner/dense_kernel.hpp>
#include <delassus/linear/inner/front_triangle.hpp>
#include <delassus/math/long_vectors.hpp>
#include <delassus/math/pivoted_lu.hpp>

#include <algorithm>
#include <span>
#include <utility>

namespace delassus {

/// P A Pᵀ = L D U with w × w blocks as `BlockLu` makes it, rows exchanged inside a block only, but in dense
/// fronts, P by nested dissection: each front is two triangles, L D with the lower one of A and Uᵀ with that
/// of Aᵀ. The pattern is analysed once; from the second time on `factor` and `solve` do not allocate. For
/// graphs that fill; a chain or a tree is cheaper in `BlockLu`. Source: as `MultifrontalCholesky`.
template <int w, class T>
class MultifrontalLu {
 public:
  using Block = Mat<w, w, T>;

  /// All diagonal blocks and, both ways, the pairs (i, j), i ≠ j, in any order, repeats allowed.
  void analyse(Index blocks, std::span<const std::pair<Index, Index>> pairs) {
    plan_.analyse(w, blocks, pairs);
    diagonal_.resize(blocks);
    pivot_.resize(blocks);
    lower_.resize(plan_.entries.row.size());
    upper_.resize(plan_.entries.row.size());
  }

  void set_identity() {
    for (Block& b : diagonal_) b = diagonal_of<w>(T(1));
    for (Block& b : lower_) set_all(b, T(0));
    for (Block& b : upper_) set_all(b, T(0));
  }
  /// A_ij, to be added to.
  Block& at(Index i, Index j) {
    const Index row = plan_.pattern.place(i), column = plan_.pattern.place(j);
    if (row == column) return diagonal_[row];
    return row > column ? lower_[plan_.entries.find(row, column)] : upper_[plan_.entries.find(column, row)];
  }

  /// Makes the factors of A; false when a pivot block is singular or not finite: then nothing may be solved.
  bool factor() {
    L_.resize(plan_);
    U_.resize(plan_);
    for (Index s = 0; s < plan_.fronts(); ++s)
      if (!factor_front(s)) return false;
    return true;
  }

  /// x ← A⁻¹ x.
  void solve(std::span<Vec<w, T>> x) const {
    y_.resize(x.size());
    for (Index i = 0; i < plan_.blocks(); ++i) y_[plan_.pattern.place(i)] = x[i];
    for (Index s = 0; s < plan_.fronts(); ++s) forward(s);
    for (Index s = plan_.fronts(); s-- > 0;) backward(s);
    for (Index i = 0; i < plan_.blocks(); ++i) x[i] = y_[plan_.pattern.place(i)];
  }

 private:
  template <class U>
  using Columns = inner::Columns<U>;

  bool factor_front(Index s) {
    const Supernode& x = plan_.supernode(s);
    L_.open(
        plan_, s, [&](Index place) -> const Block& { return diagonal_[place]; },
        [&](Index entry) -> const Block& { return lower_[entry]; });
    U_.open(
        plan_, s, [&](Index place) -> Block { return transposed(diagonal_[place]); },
        [&](Index entry) -> Block { return transposed(upper_[entry]); });
    const Columns<T> L = L_.columns(plan_, s), U = U_.columns(plan_, s);
    const Index height = w * Index(x.rows.size()), width = w * x.width, below = height - width;
    if (!factor_columns(L, U, height, x.first, x.width)) return false;
    const Columns<const T> L21{L.at(width, 0), L.stride}, U21{U.at(width, 0), U.stride};
    kernel_.negated_product(L_.part(plan_, s), L21, U21, below, below, width, true);
    kernel_.negated_product(U_.part(plan_, s), U21, L21, below, below, width, true);
    L_.pass_on(plan_, s);
    U_.pass_on(plan_, s);
    return true;
  }

  /// The pivots at places first … first + count − 1 of a front, whose first one begins both columns. By
  /// halves: left half, its product off the right half, right half.
  bool factor_columns(Columns<T> L, Columns<T> U, Index height, Index first, Index count) {
    if (count == 1) return factor_pivot(L, U, height, pivot_[first]);
    const Index half = count / 2, width = w * half, rest = w * (count - half);
    if (!factor_columns(L, U, height, first, half)) return false;
    const Columns<const T> L1{L.at(width, 0), L.stride}, U1{U.at(width, 0), U.stride};
    kernel_.subtract(L.from(width, width), L1, U1, height - width, rest, width, true);
    kernel_.subtract(U.from(width, width), U1, L1, height - width, rest, width, true);
    return factor_columns(L.from(width, width), U.from(width, width), height - width, first + half,
                          count - half);
  }

  /// D, whose lower triangle is L's and the other U's, and D⁻¹ A_jk below it in U.
  static bool factor_pivot(Columns<T> L, Columns<T> U, Index height, PivotedLu<w, T>& pivot) {
    Block D;
    for (int c = 0; c < w; ++c)
      for (int r = 0; r < w; ++r) D(r, c) = r >= c ? *L.at(r, c) : *U.at(c, r);
    if (!pivot.factor(D)) return false;
    pivot.solve_rows([&](int k) { return U.at(w, k); }, height - w);
    return true;
  }

  /// y ← (L D)⁻¹ y, the share of one supernode; rows are gathered so that columns are read from end to end.
  void forward(Index s) const {
    const Supernode& x = plan_.supernode(s);
    const Index height = w * Index(x.rows.size());
    const Columns<const T> L = L_.columns(plan_, s);
    gather_.assign(height, T(0));
    for (Index k = 0; k < x.width; ++k) std::copy_n(y_[x.first + k].data(), w, &gather_[w * k]);
    for (Index k = 0; k < x.width; ++k) {
      const Index next = w * (k + 1), rest = height - next;
      Vec<w, T>& y = y_[x.first + k];
      std::copy_n(&gather_[w * k], w, y.data());
      pivot_[x.first + k].solve(y);
      for (int c = 0; c < w; ++c)
        add_multiple<T>(-y[c], L.at(next, w * k + c), gather_.data() + next, rest);
    }
    for (Index k = x.width; k < Index(x.rows.size()); ++k)
      for (int c = 0; c < w; ++c) y_[x.rows[k]][c] += gather_[w * k + c];
  }
  /// y ← U⁻¹ y.
  void backward(Index s) const {
    const Supernode& x = plan_.supernode(s);
    const Index height = w * Index(x.rows.size());
    const Columns<const T> U = U_.columns(plan_, s);
    gather_.resize(height);
    for (Index k = 0; k < Index(x.rows.size()); ++k) std::copy_n(y_[x.rows[k]].data(), w, &gather_[w * k]);
    for (Index k = x.width; k-- > 0;) {
      const Index next = w * (k + 1), rest = height - next;
      for (int c = 0; c < w; ++c)
        gather_[w * k + c] -= sum_of_products<T>(U.at(next, w * k + c), gather_.data() + next, rest);
      std::copy_n(&gather_[w * k], w, y_[x.first + k].data());
    }
  }

  inner::FrontPlan plan_;
  Array<Block> diagonal_, lower_,
      upper_;  ///< of A: by place, and by entry below and above the diagonal
  Array<PivotedLu<w, T>> pivot_;
  inner::FrontTriangle<w, T> L_, U_;
  inner::DenseKernel<T> kernel_;
  mutable Array<Vec<w, T>> y_;
  mutable Array<T> gather_;
};

}  // namespace delassus
