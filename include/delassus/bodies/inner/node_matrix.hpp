/// The matrix of a deformable body: 3 × 3 blocks where two nodes share an element, in places found once.
#pragma once

#include <delassus/core/index.hpp>
#include <delassus/linear/multifrontal_cholesky.hpp>
#include <delassus/math/linear.hpp>

#include <algorithm>
#include <array>
#include <span>
#include <utility>
#include <vector>

namespace delassus::inner {

/// The pairs of an element's n nodes: (0, 1), (0, 2), … (n − 2, n − 1).
template <int n>
inline constexpr auto pairs_of_nodes = [] {
  std::array<std::array<int, 2>, n*(n - 1) / 2> pairs{};
  for (int a = 0, k = 0; a < n; ++a)
    for (int b = a + 1; b < n; ++b, ++k) pairs[k] = {a, b};
  return pairs;
}();

/// Symmetric: the diagonal, and K_ij of the pairs i < j of elements of `corners` nodes. `slots(e)[k]` is
/// where pair k of element e goes.
template <class T, int corners>
class NodeMatrix {
 public:
  using Block = Mat<3, 3, T>;
  using Velocity = Vec<3, T>;
  static constexpr int pairs_each = corners * (corners - 1) / 2;

  void analyse(Index nodes, std::span<const std::array<Index, corners>> elements,
               std::span<const Vec3> positions) {
    pairs_.clear();
    for (const auto& t : elements)
      for (const auto& [a, b] : pairs_of_nodes<corners>) pairs_.emplace_back(std::minmax(t[a], t[b]));
    const auto all = pairs_;
    std::sort(pairs_.begin(), pairs_.end());
    pairs_.erase(std::unique(pairs_.begin(), pairs_.end()), pairs_.end());
    slots_.resize(elements.size());
    for (std::size_t k = 0; k < all.size(); ++k)
      slots_[k / pairs_each][k % pairs_each] =
          Index(std::lower_bound(pairs_.begin(), pairs_.end(), all[k]) - pairs_.begin());
    diagonal_.resize(nodes);
    upper_.resize(pairs_.size());
    factor_.analyse(nodes, pairs_, positions);
  }

  void set_zero() {
    for (Block& b : diagonal_) b.setZero();
    for (Block& b : upper_) b.setZero();
  }
  void add_diagonal(Index i, const Block& block) { diagonal_[i] += block; }
  /// Pair k of element e; the block is of the lower node's row and the higher one's column.
  void add_pair(Index e, int k, const Block& block) { upper_[slots_[e][k]] += block; }

  /// y += s K x.
  void add_product(T s, const std::vector<Velocity>& x, std::vector<Velocity>& y) const {
    for (std::size_t i = 0; i < diagonal_.size(); ++i) y[i] += s * (diagonal_[i] * x[i]);
    for (std::size_t e = 0; e < pairs_.size(); ++e) {
      const auto [i, j] = pairs_[e];
      y[i] += s * (upper_[e] * x[j]);
      y[j] += s * (upper_[e].transpose() * x[i]);
    }
  }

  /// The pairs i < j that share an element.
  std::span<const std::pair<Index, Index>> pairs() const { return pairs_; }

  /// mass_share M + stiffness_share K on the nodes that are not held, 1 on the others, for a factor of any
  /// scalar.
  template <class F>
  void enter(F& factor, T mass_share, T stiffness_share, std::span<const T> mass,
             std::span<const char> is_held) const {
    using Other = typename F::Block;
    using S = typename Other::Scalar;
    factor.set_zero();
    for (Index i = 0; i < Index(diagonal_.size()); ++i) {
      Block A = Block::Identity();
      if (!is_held[i]) {
        A = stiffness_share * diagonal_[i];
        for (int k = 0; k < 3; ++k) A(k, k) += mass_share * mass[i];
      }
      factor.add_diagonal(i, Other(A.template cast<S>()));
    }
    for (std::size_t e = 0; e < pairs_.size(); ++e) {
      const auto [i, j] = pairs_[e];
      if (!is_held[i] && !is_held[j])
        factor.add_pair(i, j, Other((stiffness_share * upper_[e]).template cast<S>()));
    }
  }
  /// Factors it; false where there is no factor.
  bool factor(T mass_share, T stiffness_share, std::span<const T> mass, std::span<const char> is_held) {
    enter(factor_, mass_share, stiffness_share, mass, is_held);
    return factor_.factor();
  }
  void solve(std::vector<Velocity>& x) const { factor_.solve(x); }
  /// The rows and columns of the inverse that belong to `nodes`, 3n × 3n by columns.
  void compliance(std::span<const Index> nodes, std::span<T> C) const { factor_.compliance(nodes, C); }

 private:
  std::vector<std::pair<Index, Index>> pairs_;
  std::vector<std::array<Index, pairs_each>> slots_;
  std::vector<Block> diagonal_, upper_;
  MultifrontalCholesky<3, T> factor_;
};

}  // namespace delassus::inner
