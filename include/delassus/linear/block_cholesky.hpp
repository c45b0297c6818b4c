/// Sparse Cholesky factorization of a symmetric positive definite matrix of small square blocks.
#pragma once

#include <delassus/core/index.hpp>
#include <delassus/math/linear.hpp>

#include <Eigen/Cholesky>

#include <algorithm>
#include <iterator>
#include <set>
#include <span>
#include <utility>
#include <vector>

namespace delassus {

/// P A Pᵀ = L Lᵀ with w × w blocks, P by minimum degree. The pattern is analysed once; `factor` and
/// `solve` do not allocate. Right-looking: when a column is done, its outer product is taken from the columns after.
template <int w, class T>
class BlockCholesky {
 public:
  using Block = Mat<w, w, T>;

  /// Pattern of the lower triangle: all diagonal blocks and the pairs (i, j), i ≠ j, in any order, repeats allowed.
  void analyse(Index blocks, std::span<const std::pair<Index, Index>> pairs) {
    order(blocks, pairs);
    std::vector<std::vector<Index>> below(blocks);
    for (auto [i, j] : pairs) {
      const auto [column, row] = std::minmax(place_[i], place_[j]);
      below[column].push_back(row);
    }
    start_.assign(1, 0);
    row_.clear();
    for (Index j = 0; j < blocks; ++j) {
      auto& rows = below[j];
      sort_unique(rows);
      // Fill: the rows below the first one of a column appear in that first row's column too.
      if (!rows.empty()) below[rows[0]].insert(below[rows[0]].end(), rows.begin() + 1, rows.end());
      row_.insert(row_.end(), rows.begin(), rows.end());
      start_.push_back(Index(row_.size()));
    }
    diagonal_.resize(blocks);
    lower_.resize(row_.size());
    work_.resize(blocks);
  }

  void set_zero() {
    for (Block& b : diagonal_) b.setZero();
    for (Block& b : lower_) b.setZero();
  }
  /// A_ii += block.
  void add_diagonal(Index i, const Block& block) { diagonal_[place_[i]] += block; }
  /// A_ij += block and A_ji += blockᵀ, i ≠ j.
  void add_pair(Index i, Index j, const Block& block) {
    if (place_[i] > place_[j]) lower_[find(place_[i], place_[j])] += block;
    else lower_[find(place_[j], place_[i])] += block.transpose();
  }

  /// Replaces A by its factor; false when a pivot block is not positive definite.
  bool factor() {
    for (Index j = 0; j < Index(diagonal_.size()); ++j) {
      const Eigen::LLT<Block> pivot(diagonal_[j]);
      if (pivot.info() != Eigen::Success) return false;
      diagonal_[j] = pivot.matrixL();
      const auto L = diagonal_[j].template triangularView<Eigen::Lower>();
      for (Index e = start_[j]; e < start_[j + 1]; ++e)
        lower_[e] = L.solve(Block(lower_[e].transpose())).transpose();
      for (Index e = start_[j]; e < start_[j + 1]; ++e) {
        diagonal_[row_[e]].noalias() -= lower_[e] * lower_[e].transpose();
        for (Index f = e + 1; f < start_[j + 1]; ++f)
          lower_[find(row_[f], row_[e])].noalias() -= lower_[f] * lower_[e].transpose();
      }
    }
    return true;
  }

  /// x ← A⁻¹ x.
  void solve(std::vector<Vec<w, T>>& x) const {
    const Index n = Index(diagonal_.size());
    for (Index i = 0; i < n; ++i) work_[place_[i]] = x[i];
    for (Index j = 0; j < n; ++j) {
      diagonal_[j].template triangularView<Eigen::Lower>().solveInPlace(work_[j]);
      for (Index e = start_[j]; e < start_[j + 1]; ++e) work_[row_[e]].noalias() -= lower_[e] * work_[j];
    }
    for (Index j = n; j-- > 0;) {
      for (Index e = start_[j]; e < start_[j + 1]; ++e)
        work_[j].noalias() -= lower_[e].transpose() * work_[row_[e]];
      diagonal_[j].transpose().template triangularView<Eigen::Upper>().solveInPlace(work_[j]);
    }
    for (Index i = 0; i < n; ++i) x[i] = work_[place_[i]];
  }

 private:
  /// Minimum degree: the block with the fewest neighbours goes next, and its neighbours become neighbours of each
  /// other. Ties go to the lowest number. Plain lists; its cost is that of the fill.
  void order(Index blocks, std::span<const std::pair<Index, Index>> pairs) {
    std::vector<std::vector<Index>> near(blocks);
    for (auto [i, j] : pairs) {
      near[i].push_back(j);
      near[j].push_back(i);
    }
    for (auto& list : near) sort_unique(list);
    std::set<std::pair<Index, Index>> queue;  // (degree, block)
    for (Index b = 0; b < blocks; ++b) queue.emplace(Index(near[b].size()), b);
    place_.resize(blocks);
    std::vector<Index> merged;
    for (Index k = 0; k < blocks; ++k) {
      const Index b = queue.begin()->second;
      queue.erase(queue.begin());
      place_[b] = k;
      for (const Index n : near[b]) {
        queue.erase({Index(near[n].size()), n});
        merged.clear();
        std::set_union(near[n].begin(), near[n].end(), near[b].begin(), near[b].end(), std::back_inserter(merged));
        std::erase_if(merged, [&](Index i) { return i == n || i == b; });
        near[n] = merged;
        queue.emplace(Index(near[n].size()), n);
      }
    }
  }

  static void sort_unique(std::vector<Index>& list) {
    std::sort(list.begin(), list.end());
    list.erase(std::unique(list.begin(), list.end()), list.end());
  }

  Index find(Index row, Index column) const {
    const auto first = row_.begin() + start_[column], last = row_.begin() + start_[column + 1];
    return Index(std::lower_bound(first, last, row) - row_.begin());
  }

  std::vector<Index> place_, start_, row_;
  std::vector<Block> diagonal_, lower_;
  mutable std::vector<Vec<w, T>> work_;
};

}  // namespace delassus
