/// CHOLMOD's supernodal Cholesky factorization behind the concept of ours.
#pragma once

#include <delassus/core/cmath.hpp>
#include <delassus/core/expect.hpp>
#include <delassus/linear/factorization.hpp>

#include <algorithm>
#include <cholmod.h>
#include <cstddef>
#include <span>
#include <utility>
#include <vector>

namespace delassus {

/// P A Pᵀ = L Lᵀ with w × w blocks of doubles, P by METIS where CHOLMOD has it. For comparison, and for who
/// has a BLAS that suits the machine: `solve` and `compliance` allocate. Of one thread at a time.
template <int w>
class CholmodFactor {
 public:
  /// The entries between two nodes.
  using Block = Mat<w, w>;

  CholmodFactor() {
    cholmod_start(&common_);
    common_.print = 0;
    common_.supernodal = CHOLMOD_SUPERNODAL;
    common_.final_ll = 1;
    common_.nmethods = 1;
    common_.method[0].ordering = CHOLMOD_METIS;
    common_.postorder = 1;
  }
  CholmodFactor(const CholmodFactor&) = delete;
  CholmodFactor& operator=(const CholmodFactor&) = delete;
  ~CholmodFactor() {
    cholmod_free_factor(&L_, &common_);
    cholmod_finish(&common_);
  }

  /// All diagonal blocks and the pairs (i, j), i ≠ j, in any order, repeats allowed.
  void analyse(Index blocks, std::span<const std::pair<Index, Index>> pairs) {
    std::vector<std::pair<Index, Index>> lower;  // (column, row)
    for (const auto& [i, j] : pairs) lower.emplace_back(std::minmax(i, j));
    std::sort(lower.begin(), lower.end());
    lower.erase(std::unique(lower.begin(), lower.end()), lower.end());
    first_.assign(std::size_t(blocks) + 1, 0);
    rows_.clear();
    for (const auto& [column, row] : lower) ++first_[column + 1], rows_.push_back(row);
    for (Index b = 0; b < blocks; ++b) first_[b + 1] += first_[b];
    start_.assign(1, 0);
    row_.clear();
    for (Index b = 0; b < blocks; ++b)
      for (int c = 0; c < w; ++c) {
        for (int r = c; r < w; ++r) row_.push_back(int(w * b + r));
        for (Index e = first_[b]; e < first_[b + 1]; ++e)
          for (int r = 0; r < w; ++r) row_.push_back(int(w * rows_[e] + r));
        start_.push_back(int(row_.size()));
      }
    A_.assign(row_.size(), 0);
    is_factored_ = false;
    view_ = {};
    view_.nrow = view_.ncol = std::size_t(w) * std::size_t(blocks);
    view_.nzmax = A_.size();
    view_.p = start_.data(), view_.i = row_.data(), view_.x = A_.data();
    view_.stype = -1, view_.itype = CHOLMOD_INT, view_.xtype = CHOLMOD_REAL, view_.dtype = CHOLMOD_DOUBLE;
    view_.sorted = view_.packed = 1;
    cholmod_free_factor(&L_, &common_);
    if (blocks == 0) return;
    L_ = cholmod_analyze(&view_, &common_);
    DELASSUS_EXPECT(L_ != nullptr,
                    "CholmodFactor: CHOLMOD could not analyse the pattern; is there memory for it?");
  }

  /// Nodes of the pattern; −1 before `analyse`.
  Index blocks() const { return Index(first_.size()) - 1; }
  /// A = 0, with the same pattern.
  void set_zero() { std::fill(A_.begin(), A_.end(), 0.); }
  /// A_ii += block.
  void add_diagonal(Index i, const Block& block) {
    for (int c = 0; c < w; ++c)
      for (int r = c; r < w; ++r) A_[std::size_t(start_[w * i + c] + r - c)] += block(r, c);
  }
  /// A_ij += block, A_ji += blockᵀ, for a pair of the pattern.
  void add_pair(Index i, Index j, const Block& block) {
    const Index row = std::max(i, j), column = std::min(i, j);
    const auto begin = rows_.begin() + first_[column], end = rows_.begin() + first_[column + 1];
    const int at = w * int(std::lower_bound(begin, end, row) - begin);
    for (int c = 0; c < w; ++c)
      for (int r = 0; r < w; ++r)
        A_[std::size_t(start_[w * column + c] + (w - c) + at + r)] += i > j ? block(r, c) : block(c, r);
  }

  /// Makes the factor of A; false when A is not positive definite, or not finite, of which CHOLMOD says
  /// nothing: then nothing may be solved.
  bool factor() {
    is_factored_ = std::all_of(A_.begin(), A_.end(), [](double a) { return std::isfinite(a); });
    if (!is_factored_ || blocks() == 0) return is_factored_;
    cholmod_factorize(&view_, L_, &common_);
    return is_factored_ = common_.status == CHOLMOD_OK && L_->minor == L_->n;
  }
  /// x ← A⁻¹ x.
  void solve(std::span<Vec<w>> x) const {
    if (!x.empty()) solve_in_place(x[0].data(), 1);
  }

  /// The rows and columns of A⁻¹ of some nodes, each named once: C is (w n) × (w n) by columns.
  void compliance(std::span<const Index> nodes, std::span<double> C) const {
    const std::size_t columns = w * nodes.size(), n = view_.nrow;
    std::vector<double> S(n * columns, 0.);
    for (std::size_t k = 0; k < columns; ++k) S[w * std::size_t(nodes[k / w]) + k % w + k * n] = 1;
    solve_in_place(S.data(), columns);
    for (std::size_t j = 0; j < columns; ++j)
      for (std::size_t i = 0; i < columns; ++i)
        C[i + j * columns] = S[w * std::size_t(nodes[i / w]) + i % w + j * n];
  }

 private:
  void solve_in_place(double* x, std::size_t columns) const {
    DELASSUS_EXPECT(is_factored_, "CholmodFactor: there is no factor to solve with");
    if (columns == 0) return;
    cholmod_dense B{};
    B.nrow = B.d = view_.nrow, B.ncol = columns, B.nzmax = view_.nrow * columns;
    B.x = x, B.xtype = CHOLMOD_REAL, B.dtype = CHOLMOD_DOUBLE;
    cholmod_dense* X = cholmod_solve(CHOLMOD_A, L_, &B, &common_);
    DELASSUS_EXPECT(X != nullptr, "CholmodFactor: CHOLMOD could not solve; is there memory for it?");
    std::copy_n(static_cast<const double*>(X->x), B.nzmax, x);
    cholmod_free_dense(&X, &common_);
  }

  mutable cholmod_common common_{};
  cholmod_sparse view_{};
  cholmod_factor* L_ = nullptr;
  std::vector<Index> first_, rows_;  ///< blocks below the diagonal, by columns
  std::vector<int> start_, row_;     ///< numbers of the lower triangle, by columns
  std::vector<double> A_;
  bool is_factored_ = false;
};
static_assert(Factorization<CholmodFactor<3>, 3, double>);

}  // namespace delassus
