/// The matrix of a deformable body: 3 × 3 blocks where two nodes share an element, in places found once.
#pragma once

#include <delassus/core/array.hpp>
#include <delassus/core/index.hpp>
#include <delassus/core/ranges.hpp>
#include <delassus/core/sort.hpp>
#include <delassus/fem/inner/pairs_of_nodes.hpp>
#include <delassus/fem/inner/tie.hpp>
#include <delassus/linear/multifrontal_cholesky.hpp>
#include <delassus/math/lanes.hpp>
#include <delassus/math/linear.hpp>

#include <algorithm>
#include <array>
#include <cstdlib>
#include <span>
#include <type_traits>
#include <utility>

namespace delassus::inner {

/// Symmetric: K_ij of the pairs i < j of elements of `corners` nodes, which every element names in ascending
/// order; where each of its blocks goes is looked up once. No shift of all nodes strains, so that
///
///   K_ii = −Σ_j K_ij,
///
/// and elements say nothing of the diagonal. Ties are beside the elements, for good. The numbers of a block
/// but its last lie in one line of the cache.
template <class T, int corners, bool has_ties = false>
class NodeMatrix {
 public:
  using Block = Mat<3, 3, T>;
  using Velocity = Vec<3, T>;
  using Factor = MultifrontalCholesky<3, T>;
  static constexpr int pairs_each = corners * (corners - 1) / 2;

  /// The first `batched` elements are going to be added lane_count at a time.
  void analyse(Index nodes, std::span<const std::array<Index, corners>> elements, Index batched,
               std::span<const Tie> ties, std::span<const Vec3> positions) {
    pairs_.clear();
    for (const auto& t : elements)
      for (const auto& [a, b] : pairs_of_nodes<corners>) pairs_.emplace_back(t[a], t[b]);
    const auto all = pairs_;
    for (const Tie& tie : ties) pairs_.emplace_back(tie.i, tie.j);
    inner::sort(pairs_);
    inner::drop_repeats(pairs_);
    const auto place_of = [&](const std::pair<Index, Index>& pair) {
      return Index(inner::lower_bound(pairs_.data(), pairs_.data() + pairs_.size(), pair) - pairs_.begin());
    };
    places_.resize(elements.size());
    for (std::size_t e = 0; e < elements.size(); ++e)
      for (int k = 0; k < pairs_each; ++k) places_[e][k] = 1 + place_of(all[e * pairs_each + k]);
    ties_.assign(has_ties ? pairs_.size() : 0, T(0));
    tie_sums_.assign(has_ties ? nodes : 0, T(0));
    for (const Tie& tie : ties) {
      ties_[place_of({tie.i, tie.j})] = T(tie.k);
      tie_sums_[tie.i] += T(tie.k), tie_sums_[tie.j] += T(tie.k);
    }
    mark_first(batched);
    eights_.assign(1 + pairs_.size(), {});
    ninths_.assign(1 + pairs_.size(), T(0));
    diagonal_.assign(nodes, Block::Zero());
    sums_.assign(nodes, {});
    ninth_sums_.assign(nodes, T(0));
    factor_.analyse(nodes, pairs_, positions);
  }

  /// Pair k of element e. All elements are added in ascending order, and what is there from the last time is
  /// written over.
  void add(Index e, int k, const Mat3& block) {
    const auto [to, from] = place(places_[e][k]);
    for (int i = 0; i < 8; ++i) eights_[to].e[i] = eights_[from].e[i] + T(block.data()[i]);
    ninths_[to] = ninths_[from] + T(block.data()[8]);
  }
  /// Pair k of the elements e, e + 1, … of all lanes.
  void add_lanes(Index e, int k, const LaneMatrix& block) {
    Eight* const eights = eights_.data();  // known to stay, unlike what the vector says
    T* const ninths = ninths_.data();
    const auto* const places = &places_[e];
    double last[lane_count];
    store_lanes(last, block(2, 2));
    Lanes rows[8];
    for (int i = 0; i < 8; ++i) rows[i] = block(i % 3, i / 3);
    for (int first = 0; first < 8; first += lane_count) {
      transpose_lanes(&rows[first]);
      for (int l = 0; l < lane_count; ++l) {
        const auto [to, from] = place(places[l][k]);
        add_to(eights[to].e + first, eights[from].e + first, rows[first + l]);
        if (first == 0) ninths[to] = ninths[from] + T(last[l]);
      }
    }
  }
  /// K_ii, when all elements are in. It is symmetric, so that on which side of a pair i stands makes no
  /// difference: K_ii = −sym Σ K_p over the pairs p with i. Sums are zero before and after.
  void add_diagonal() {
    std::size_t p = 0;
    for (Index i = 0; i < Index(diagonal_.size()); ++i) {
      Eight sum{};
      T ninth = 0;
      for (; p < pairs_.size() && pairs_[p].first == i; ++p) {
        const Index j = pairs_[p].second;
        add_to(sum, eights_[1 + p]), add_to(sums_[j], eights_[1 + p]);
        ninth += ninths_[1 + p], ninth_sums_[j] += ninths_[1 + p];
      }
      add_to(sum, sums_[i]);
      ninth += ninth_sums_[i];
      sums_[i] = {}, ninth_sums_[i] = 0;
      const Block all = block(sum, ninth);
      diagonal_[i] = T(-0.5) * (all + all.transpose());
      if constexpr (has_ties)
        for (int k = 0; k < 3; ++k) diagonal_[i](k, k) += tie_sums_[i];
    }
  }

  /// y += s K x.
  void add_product(T s, std::span<const Velocity> x, std::span<Velocity> y) const {
    for (std::size_t i = 0; i < diagonal_.size(); ++i) y[i] += s * (diagonal_[i] * x[i]);
    for (std::size_t p = 0; p < pairs_.size(); ++p) {
      const auto [i, j] = pairs_[p];
      const Block K = block(p);
      y[i] += s * (K * x[j]);
      y[j] += s * (K.transpose() * x[i]);
    }
  }

  /// The pairs i < j that share an element or a tie.
  std::span<const std::pair<Index, Index>> pairs() const { return pairs_; }

  /// mass_share M + stiffness_share K on the nodes that are not held, 1 on the others, for a factor of any
  /// scalar.
  template <class F>
  void enter(F& factor, T mass_share, T stiffness_share, std::span<const T> mass,
             std::span<const char> is_held) const {
    factor.set_zero();
    enter_some(factor, mass_share, stiffness_share, mass, is_held, {0, Index(diagonal_.size())},
               {0, Index(pairs_.size())});
  }
  /// Factors it; false where there is no factor.
  bool factor(T mass_share, T stiffness_share, std::span<const T> mass, std::span<const char> is_held) {
    enter(factor_, mass_share, stiffness_share, mass, is_held);
    return factor_.factor();
  }
  /// The same by several workers, after `prepare`.
  template <class E>
  bool factor(T mass_share, T stiffness_share, std::span<const T> mass, std::span<const char> is_held,
              auto& by, auto& dense, const E& execution) {
    factor_.set_zero();
    const Index nodes = Index(diagonal_.size()), pairs = Index(pairs_.size()),
                tasks = tasks_of(pairs, 1024, execution.workers());
    execution.run(tasks, [&](Index task, Index) {
      enter_some(factor_, mass_share, stiffness_share, mass, is_held, range_of(nodes, task, tasks),
                 range_of(pairs, task, tasks));
    });
    return factor_.factor(by, dense, execution);
  }
  void prepare(auto& by, auto& dense, Index workers) const { factor_.prepare(by, dense, workers); }

  /// `by`: what several workers keep, and the execution, and so below.
  void solve(std::span<Velocity> x, auto&... by) const { factor_.solve(x, by...); }
  /// The rows and columns of the inverse that belong to `nodes`, 3n × 3n by columns.
  void compliance(std::span<const Index> nodes, std::span<T> C, auto&... by) const {
    factor_.compliance(nodes, C, by...);
  }

 private:
  /// Some nodes and some pairs, each in a place of its own.
  template <class F>
  [[gnu::always_inline]] void enter_some(F& factor, T mass_share, T stiffness_share, std::span<const T> mass,
                                         std::span<const char> is_held, Range nodes, Range pairs) const {
    using Other = typename F::Block;
    using S = typename Other::Scalar;
    for (Index i = nodes.first; i < nodes.last; ++i) {
      Block A = Block::Identity();
      if (!is_held[i]) {
        A = stiffness_share * diagonal_[i];
        for (int k = 0; k < 3; ++k) A(k, k) += mass_share * mass[i];
      }
      factor.add_diagonal(i, Other(A.template cast<S>()));
    }
    for (std::size_t p = pairs.first; p < std::size_t(pairs.last); ++p) {
      const auto [i, j] = pairs_[p];
      if (!is_held[i] && !is_held[j])
        factor.add_pair(i, j, Other((stiffness_share * block(p)).template cast<S>()));
    }
  }

  /// Pair p's block is the one with number 1 + p, which is kept with a minus where no element adds to it
  /// before: block 0 stays zero and is added to there, without a branch.
  struct Place {
    Index to, from;
  };
  static Place place(Index p) { return {std::abs(p), std::max(p, 0)}; }
  void mark_first(Index batched) {
    Array<char> is_met(pairs_.size(), 0);
    const auto meet = [&](Index& place) {
      if (!std::exchange(is_met[place - 1], 1)) place = -place;
    };
    for (Index e = 0; e < batched; e += lane_count)  // as add_lanes goes
      for (int k = 0; k < pairs_each; ++k)
        for (int l = 0; l < lane_count; ++l) meet(places_[e + l][k]);
    for (Index e = batched; e < Index(places_.size()); ++e)
      for (Index& place : places_[e]) meet(place);
  }
  static void add_to(double* to, const double* from, const Lanes& x) {
    store_lanes(to, load_lanes(from) + x);
  }
  static void add_to(float* to, const float* from, const Lanes& x) {
    double numbers[lane_count];
    store_lanes(numbers, x);
    for (int i = 0; i < lane_count; ++i) to[i] = from[i] + float(numbers[i]);
  }

  struct alignas(8 * sizeof(T)) Eight {
    T e[8];
  };
  static void add_to(Eight& to, const Eight& x) {
    if constexpr (std::is_same_v<T, double>)
      for (int k = 0; k < 8; k += lane_count) add_to(to.e + k, to.e + k, load_lanes(x.e + k));
    else
      for (int k = 0; k < 8; ++k) to.e[k] += x.e[k];
  }
  static Block block(const Eight& eight, T ninth) {
    Block K;
    for (int i = 0; i < 8; ++i) K.data()[i] = eight.e[i];
    K.data()[8] = ninth;
    return K;
  }
  Block block(std::size_t p) const {
    Block K = block(eights_[1 + p], ninths_[1 + p]);
    if constexpr (has_ties)
      for (int i = 0; i < 3; ++i) K(i, i) -= ties_[p];
    return K;
  }

  Array<std::pair<Index, Index>> pairs_;
  Array<std::array<Index, pairs_each>> places_;
  Array<Eight> eights_;  ///< of zeros, and of the pairs' blocks, by columns
  Array<T> ninths_;
  Array<T> ties_, tie_sums_;  ///< k of each pair, and Σ k by node, with `has_ties`
  Array<Block> diagonal_;
  Array<Eight> sums_;  ///< Σ K_p by node, and its last number: at work
  Array<T> ninth_sums_;
  Factor factor_;
};

}  // namespace delassus::inner
