/// The matrix of a deformable body: 3 × 3 blocks where two nodes share an element, in places found once.
#pragma once

#include <delassus/core/index.hpp>
#include <delassus/linear/multifrontal_cholesky.hpp>
#include <delassus/math/lanes.hpp>
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

/// Symmetric: the diagonal, and K_ij of the pairs i < j of elements of `corners` nodes, which every element
/// names in ascending order. An element's blocks are those of its nodes, then those of its pairs; where each
/// goes is looked up once.
template <class T, int corners>
class NodeMatrix {
 public:
  using Block = Mat<3, 3, T>;
  using Velocity = Vec<3, T>;
  static constexpr int pairs_each = corners * (corners - 1) / 2, blocks_each = corners + pairs_each;

  void analyse(Index nodes, std::span<const std::array<Index, corners>> elements,
               std::span<const Vec3> positions) {
    pairs_.clear();
    for (const auto& t : elements)
      for (const auto& [a, b] : pairs_of_nodes<corners>) pairs_.emplace_back(t[a], t[b]);
    const auto all = pairs_;
    std::sort(pairs_.begin(), pairs_.end());
    pairs_.erase(std::unique(pairs_.begin(), pairs_.end()), pairs_.end());
    places_.resize(elements.size());
    for (std::size_t e = 0; e < elements.size(); ++e) {
      for (int a = 0; a < corners; ++a) places_[e][a] = elements[e][a];
      for (int k = 0; k < pairs_each; ++k)
        places_[e][corners + k] =
            nodes +
            Index(std::lower_bound(pairs_.begin(), pairs_.end(), all[e * pairs_each + k]) - pairs_.begin());
    }
    nodes_ = nodes;
    blocks_.resize(nodes + pairs_.size());
    factor_.analyse(nodes, pairs_, positions);
  }

  void set_zero() {
    for (Block& b : blocks_) b.setZero();
  }
  /// Block k of element e.
  void add(Index e, int k, const Mat3& block) { blocks_[places_[e][k]] += block.template cast<T>(); }
  /// Block k of the elements e, e + 1, … of all lanes, one number of each by columns; `block` is used up.
  void add_lanes(Index e, int k, Lanes (&block)[9]) {
    double last[lane_count];
    store_lanes(last, block[8]);
    for (int first = 0; first < 8; first += lane_count) {
      transpose_lanes(&block[first]);
      for (int l = 0; l < lane_count; ++l) add_to(numbers(e + l, k) + first, block[first + l]);
    }
    for (int l = 0; l < lane_count; ++l) numbers(e + l, k)[8] += T(last[l]);
  }

  /// y += s K x.
  void add_product(T s, const std::vector<Velocity>& x, std::vector<Velocity>& y) const {
    for (Index i = 0; i < nodes_; ++i) y[i] += s * (blocks_[i] * x[i]);
    for (std::size_t e = 0; e < pairs_.size(); ++e) {
      const auto [i, j] = pairs_[e];
      y[i] += s * (blocks_[nodes_ + e] * x[j]);
      y[j] += s * (blocks_[nodes_ + e].transpose() * x[i]);
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
    for (Index i = 0; i < nodes_; ++i) {
      Block A = Block::Identity();
      if (!is_held[i]) {
        A = stiffness_share * blocks_[i];
        for (int k = 0; k < 3; ++k) A(k, k) += mass_share * mass[i];
      }
      factor.add_diagonal(i, Other(A.template cast<S>()));
    }
    for (std::size_t e = 0; e < pairs_.size(); ++e) {
      const auto [i, j] = pairs_[e];
      if (!is_held[i] && !is_held[j])
        factor.add_pair(i, j, Other((stiffness_share * blocks_[nodes_ + e]).template cast<S>()));
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
  T* numbers(Index e, int k) { return blocks_[places_[e][k]].data(); }
  static void add_to(double* to, const Lanes& x) { store_lanes(to, load_lanes(to) + x); }
  static void add_to(float* to, const Lanes& x) {
    double from[lane_count];
    store_lanes(from, x);
    for (int i = 0; i < lane_count; ++i) to[i] += float(from[i]);
  }

  std::vector<std::pair<Index, Index>> pairs_;
  std::vector<std::array<Index, blocks_each>> places_;
  Index nodes_ = 0;
  std::vector<Block> blocks_;  ///< the diagonal, then the pairs
  MultifrontalCholesky<3, T> factor_;
};

}  // namespace delassus::inner
