/// Sparse LU factorization of an unsymmetric matrix of small square blocks whose pattern is symmetric.
#pragma once

#include <delassus/core/array.hpp>
#include <delassus/core/slice.hpp>
#include <delassus/linear/block_pattern.hpp>
#include <delassus/math/long_vectors.hpp>
#include <delassus/math/pivoted_lu.hpp>
#include <delassus/math/small_products.hpp>

#include <cstddef>
#include <utility>

namespace delassus {

/// P A Pᵀ = L D U with w × w blocks, D_j the block pivots and U unit upper: rows are exchanged inside a block
/// only, so A should be one whose Schur complements are well behaved, as that of a penalty method, 1 + G S H,
/// is. The pattern is analysed once; `factor` and `solve` do not allocate. Right-looking, as `BlockCholesky`.
template <int w, class T>
class BlockLu {
 public:
  using Block = Mat<w, w, T>;
  struct Never {
    constexpr bool operator()(Index) const { return false; }
  };

  /// All diagonal blocks and, both ways, the pairs (i, j), i ≠ j, in any order, repeats allowed.
  void analyse(Index blocks, inner::Slice<const std::pair<Index, Index>> pairs);

  /// `ends(n)` is asked after the work of n products of blocks, and where it says so A is of no use; so it is
  /// in `factor`, and in `solve` x.
  template <class Ends = Never>
  void set_identity(Ends&& ends = {}) {
    for (Block& b : diagonal_) b = diagonal_of<w>(T(1));
    lower_.resize(pattern_.entries()), upper_.resize(pattern_.entries());
    for (auto* entries : {&lower_, &upper_})
      for (Block& b : *entries) {
        if (ends(1)) return;
        set_all(b, T(0));
      }
  }
  /// A_ij, to be added to.
  Block& at(Index i, Index j) {
    const Index row = pattern_.place(i), column = pattern_.place(j);
    if (row == column) return diagonal_[row];
    return row > column ? lower_[pattern_.find(row, column)] : upper_[pattern_.find(column, row)];
  }

  /// Products of blocks that `factor` makes.
  double products() const {
    double sum = 0;
    for (Index j = 0; j < pattern_.blocks(); ++j) {
      const double below = pattern_.start(j + 1) - pattern_.start(j);
      sum += 1 + below * (below + 1);
    }
    return sum;
  }

  /// Replaces A by its factors; false when a pivot block is singular or not finite.
  template <class Ends = Never>
  bool factor(Ends&& ends = {}) {
    for (Index j = 0; j < Index(diagonal_.size()); ++j) {
      if (!pivot_[j].factor(diagonal_[j])) return false;
      const Index first = pattern_.start(j), last = pattern_.start(j + 1);
      for (Index e = first; e < last; ++e) pivot_[j].solve(upper_[e]);  // U_jk = D_j⁻¹ A_jk
      if (ends(1 + last - first)) return false;
      for (Index e = first; e < last; ++e) {
        if (ends(2 * (last - e))) return false;
        const Index i = pattern_.row(e);
        add_product(lower_[e], upper_[e], diagonal_[i], T(-1));
        for (Index f = e + 1; f < last; ++f) {
          const Index at = pattern_.find(pattern_.row(f), i);
          add_product(lower_[f], upper_[e], lower_[at], T(-1));
          add_product(lower_[e], upper_[f], upper_[at], T(-1));
        }
      }
    }
    return true;
  }

  /// The same where block i has first[i + 1] − first[i] rows of its own: the rows and columns of A behind
  /// those are the identity's.
  bool factor_own_rows(inner::Slice<const Index> first) {
    for (Index j = 0; j < Index(diagonal_.size()); ++j) {
      const int k = rows(first, j);
      if (!pivot_[j].factor(diagonal_[j], k)) return false;
      for (Index e = pattern_.start(j); e < pattern_.start(j + 1); ++e)
        pivot_[j].solve(upper_[e], k, rows(first, pattern_.row(e)));
      for (Index e = pattern_.start(j); e < pattern_.start(j + 1); ++e) {
        const Index i = pattern_.row(e);
        const int r = rows(first, i);
        take_product(lower_[e], upper_[e], diagonal_[i], k, r);
        for (Index f = e + 1; f < pattern_.start(j + 1); ++f) {
          const Index at = pattern_.find(pattern_.row(f), i);
          const int s = rows(first, pattern_.row(f));
          take_product(lower_[f], upper_[e], lower_[at], k, r);
          take_product(lower_[e], upper_[f], upper_[at], k, s);
        }
      }
    }
    return true;
  }

  /// Whether det A < 0.
  bool is_negative() const {
    bool is = false;
    for (const auto& pivot : pivot_) is ^= pivot.is_negative();
    return is;
  }

  /// x ← A⁻¹ x.
  template <class Ends = Never>
  void solve(inner::Slice<Vec<w, T>> x, Ends&& ends = {}) const {
    const Index n = Index(diagonal_.size());
    for (Index i = 0; i < n; ++i) assign(work_[pattern_.place(i)], x[i]);
    for (Index j = 0; j < n; ++j) {
      if (ends(1)) return;
      if (is_zero(work_[j])) continue;  // a right side of few entries reaches the blocks above it alone
      pivot_[j].solve(work_[j]);
      for (Index e = pattern_.start(j); e < pattern_.start(j + 1); ++e)
        add_product(lower_[e], work_[j], work_[pattern_.row(e)], T(-1));
    }
    for (Index j = n; j-- > 0;) {
      if (ends(1)) return;
      for (Index e = pattern_.start(j); e < pattern_.start(j + 1); ++e)
        add_product(upper_[e], work_[pattern_.row(e)], work_[j], T(-1));
    }
    for (Index i = 0; i < n; ++i) assign(x[i], work_[pattern_.place(i)]);
  }

  /// X ← A⁻¹ X for many columns at once, which lie beside each other: row r of block i is
  /// X[(first[i] + r) columns] …, r < first[i + 1] − first[i]. The rows and columns of A behind those are the
  /// identity's.
  void solve(T* X, Index columns, inner::Slice<const Index> first) const {
    const Index n = Index(diagonal_.size());
    const auto row = [&](Index i, int r) { return X + std::ptrdiff_t(first[i] + r) * columns; };
    for (Index j = 0; j < n; ++j) {
      const Index from = block_[j];
      const int used = rows(first, j);
      if (are_zero(row(from, 0), std::ptrdiff_t(used) * columns)) continue;
      pivot_[j].solve_rows([&](int k) { return row(from, k); }, columns, used);
      for (Index e = pattern_.start(j); e < pattern_.start(j + 1); ++e)
        take_rows(lower_[e], used, rows(first, pattern_.row(e)), row(from, 0),
                  row(block_[pattern_.row(e)], 0), columns);
    }
    for (Index j = n; j-- > 0;)
      for (Index e = pattern_.start(j); e < pattern_.start(j + 1); ++e)
        take_rows(upper_[e], rows(first, pattern_.row(e)), rows(first, j), row(block_[pattern_.row(e)], 0),
                  row(block_[j], 0), columns);
  }

 private:
  static bool are_zero(const T* x, std::ptrdiff_t n) {
    for (std::ptrdiff_t i = 0; i < n; ++i)
      if (x[i] != T(0)) return false;
    return true;
  }
  /// That the block at place j has of its own.
  int rows(inner::Slice<const Index> first, Index j) const {
    return int(first[block_[j] + 1] - first[block_[j]]);
  }
  /// r rows less B times k rows, each of so many columns.
  static void take_rows(const Block& B, int k, int r, const T* from, T* to, Index columns) {
    T less[w];
    for (int i = 0; i < r; ++i) {
      for (int c = 0; c < k; ++c) less[c] = -B(i, c);
      add_multiples(less, k, from, columns, to + std::ptrdiff_t(i) * columns, columns);
    }
  }
  /// C −= A B, of any rows times k × c: the rows of A behind its own are zero.
  static void take_product(const Block& A, const Block& B, Block& C, int k, int c) {
    if (k + c == 2 * w) return add_product(A, B, C, T(-1));
    for (int j = 0; j < c; ++j) {
      T* const to = C.data() + w * j;
      for (int n = 0; n < k; ++n) {
        const T b = B(n, j);
        DELASSUS_UNROLL
        for (int i = 0; i < w; ++i) to[i] -= A.data()[i + w * n] * b;
      }
    }
  }

  BlockPattern pattern_;
  Array<Block> diagonal_, lower_, upper_;
  Array<PivotedLu<w, T>> pivot_;
  Array<Index> block_;  ///< at a place of the order
  mutable Array<Vec<w, T>> work_;
};

template <int w, class T>
void BlockLu<w, T>::analyse(Index blocks, inner::Slice<const std::pair<Index, Index>> pairs) {
  pattern_.analyse(blocks, pairs);
  diagonal_.resize(blocks);
  pivot_.resize(blocks);
  work_.resize(blocks);
  block_.resize(blocks);
  for (Index b = 0; b < blocks; ++b) block_[pattern_.place(b)] = b;
}

}  // namespace delassus
