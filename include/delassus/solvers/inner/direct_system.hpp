/// The bilateral rows of an island as one sparse matrix, factored whatever their rank.
#pragma once

#include <delassus/core/array.hpp>
#include <delassus/linear/sparse_lu.hpp>
#include <delassus/math/small_products.hpp>
#include <delassus/rows/row_system.hpp>
#include <delassus/solvers/inner/island_matrices.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

namespace delassus::inner {

/// H and G = A⁻¹ Hᵀ of one constraint on one block that moves, filled up with zeros to the largest sizes of
/// the loop.
template <int w, int width>
struct DirectSide {
  Index node, block;
  Mat<w, width> H;
  Mat<width, w> G;
};

/// One constraint: its place, its sides, and what stands on W's diagonal beside H G.
template <int w>
struct DirectNode {
  int pool, rows;
  Index item, first, last;
  Vec<w> compliance;
  Vec<w> scale;  ///< |W_kk|, 1/kg; zero: nothing answers to the row
};

template <class Rows>
class DirectSystem;

/// The equations of the bilateral constraints b, with a velocity y for each hub, a block that more than
/// `most` of them hold:
///
///   [ W′ + ε diag W   H_hub ] [δ]   [−r]
///   [ −G_hub            1   ] [y] = [ 0],   W′ = Σ H G over the other blocks.
///
/// Without hubs that is W + ε diag W. A chain, a tree and a loop of n joints are factored in O(n), however
/// many joints a body has: a hub in W would join all of them. Its symmetric part is positive definite in the
/// metric of A, so every order of elimination has pivots. ε makes dependent rows solvable: where they agree,
/// their share of δ is the smallest; its own error goes by repetition. Source: [Vanderbei1995] for the order,
/// [Carpentier2021] for ε and repetition.
template <class T, int... widths, int... R>
class DirectSystem<RowSystem<T, Widths<widths...>, R...>> {
 public:
  using Rows = RowSystem<T, Widths<widths...>, R...>;
  static constexpr int pools = int(sizeof...(R));
  static constexpr int w = std::max({R...}), width = std::max({1, widths...});
  static constexpr int most = 5;                     ///< bilateral constraints of a block that is no hub
  static constexpr int parts = (width + w - 1) / w;  ///< nodes of the matrix that a hub takes
  using Row = Vec<w>;
  using Twist = Vec<width>;
  using Node = DirectNode<w>;
  using Side = DirectSide<w, width>;

  void begin() {
    static_assert(sizeof...(widths) > 0,
                  "delassus: the direct path needs the bodies of a problem, and this one, as a FrictionProblem, has W alone; "
                  "solve it by AcceleratedGaussSeidel");
    for (const auto& [s, b] : blocks_) number_[s][b] = -1;
    blocks_.clear();
    nodes_.clear();
    sides_.clear();
    bilateral_ = 0;
  }

  /// Takes item i of pool p as the next constraint; the bilateral ones come first. False where the set's A
  /// couples blocks.
  template <int p>
  bool take(const Rows& rows, Index i, bool is_bilateral) {
    constexpr int r = Rows::template rows_of<p>;
    const auto& pool = rows.template pool<p>();
    Node node{p, r, i, Index(sides_.size()), 0, zero<Row>(), zero<Row>()};
    bool is_alone = true;
    for_each_index<Rows::set_count>([&](auto s) {
      constexpr int narrow = Rows::template width_of<s>;
      const auto& set = std::get<s>(pool.sets);
      if (set.offset[i + 1] > set.offset[i] && set.G.size() != set.H.size()) is_alone = false;
      if (!is_alone) return;
      for (Index e = set.offset[i]; e < set.offset[i + 1]; ++e) {
        if (is_zero(set.G[e])) continue;
        Side& side = sides_.emplace_back();
        side.node = Index(nodes_.size());
        side.block = number(s, set.block[e]);
        if constexpr (r < w || narrow < width) set_all(side.H, 0.0), set_all(side.G, 0.0);
        for (int k = 0; k < narrow; ++k)
          for (int j = 0; j < r; ++j) side.H(j, k) = double(set.H[e](j, k)), side.G(k, j) = double(set.G[e](k, j));
      }
    });
    node.last = Index(sides_.size());
    measure(node);
    for (int k = 0; k < r; ++k) {
      node.compliance[k] = double(pool.compliance[i][k]) + double(pool.relative_compliance[i][k]) * node.scale[k];
      node.scale[k] = std::abs(node.scale[k]) + node.compliance[k];
    }
    nodes_.push_back(node);
    if (is_bilateral) ++bilateral_;
    return is_alone;
  }

  /// Lists sides by block and brings the analysis of graph `which` up to date.
  void analyse(Index which) {
    list_sides();
    number_hubs();
    list_pairs();
    matrix_ = &matrices_.of(which, size_, pairs_);
    x_.resize(size_);
  }

  /// False when a pivot block is singular to working precision.
  bool factor(double epsilon) {
    auto& A = *matrix_;
    A.set_identity();
    for (Index k = 0; k < bilateral_; ++k) {
      auto& own = A.at(k, k);
      const Node& node = nodes_[k];
      for (int j = 0; j < node.rows; ++j)
        own(j, j) = node.scale[j] > 0 ? node.compliance[j] + epsilon * node.scale[j] : 1;
    }
    for (Index b = 0; b < Index(blocks_.size()); ++b)
      each_bilateral(b, [&](const Side& e) {
        if (hub_[b] >= 0)
          join_hub(A, e, hub_[b]);
        else
          each_bilateral(b, [&](const Side& f) { A.at(e.node, f.node) += e.H * f.G; });
      });
    return A.factor();
  }

  /// The right side ← −velocity(p, item), where something answers. Returns √Σ u²/W_kk, the size of it.
  double load(const auto& velocity) {
    clear();
    double square = 0;
    each([&](auto p, Index k) {
      const auto u = velocity(p, nodes_[k].item);
      for (int r = 0; r < nodes_[k].rows; ++r) {
        if (!(nodes_[k].scale[r] > 0)) continue;
        x_[k][r] = -double(u[r]);
        square += double(u[r]) * double(u[r]) / nodes_[k].scale[r];
      }
    });
    return std::sqrt(square);
  }
  void clear() {
    for (Row& x : x_) set_all(x, 0.0);
  }
  void set_right_side(Index k, const Row& r) { x_[k] = r; }
  void solve() { matrix_->solve(x_); }
  /// δ of bilateral constraint k after `solve`.
  const Row& answer(Index k) const { return x_[k]; }
  /// Sets the answers aside, so that the right side can be loaded anew.
  void keep() { step_ = x_; }
  const Row& step(Index k) const { return step_[k]; }

  /// What impulse c of constraint e's side does to the right side: −H G on neighbours, G on a hub.
  void disturb(const Side& e, int c) {
    if (hub_[e.block] >= 0) {
      for (int k = 0; k < width; ++k) x_[hub_[e.block] + k / w][k % w] += e.G(k, c);
    } else {
      each_bilateral(e.block, [&](const Side& f) { x_[f.node] -= f.H * column(e.G, c); });
    }
  }

  Index bilateral() const { return bilateral_; }
  Index count() const { return Index(nodes_.size()); }
  std::size_t blocks() const { return blocks_.size(); }
  const Node& node(Index k) const { return nodes_[k]; }
  const Side& side(Index e) const { return sides_[e]; }
  bool is_held(Index block) const { return held_[block] > 0; }

  /// f(p, k) for the bilateral constraints, p their pool as a constant.
  void each(auto&& f) const {
    for_each_index<pools>([&](auto p) {
      for (Index k = 0; k < bilateral_; ++k)
        if (nodes_[k].pool == p) f(p, k);
    });
  }

 private:
  Index number(int s, Index b) {
    auto& number = number_[s];
    if (Index(number.size()) <= b) number.resize(b + 1, -1);
    if (number[b] < 0) {
      number[b] = Index(blocks_.size());
      blocks_.emplace_back(s, b);
    }
    return number[b];
  }

  /// scale ← the diagonal of Σ H G over the node's own sides.
  void measure(Node& node) const {
    for (Index e = node.first; e < node.last; ++e)
      for (Index f = node.first; f < node.last; ++f)
        if (sides_[e].block == sides_[f].block)
          for (int k = 0; k < node.rows; ++k) node.scale[k] += row_times_column(sides_[e].H, k, sides_[f].G, k);
  }

  /// The bilateral sides of block b are order_[start_[b]] … : a counting sort.
  void list_sides() {
    start_.assign(blocks_.size() + 1, 0);
    const Index end = bilateral_ > 0 ? nodes_[bilateral_ - 1].last : 0;
    for (Index e = 0; e < end; ++e) ++start_[sides_[e].block + 1];
    held_.assign(start_.begin() + 1, start_.end());
    for (std::size_t b = 0; b < blocks_.size(); ++b) start_[b + 1] += start_[b];
    order_.resize(end);
    next_.assign(start_.begin(), start_.end());
    for (Index e = 0; e < end; ++e) order_[next_[sides_[e].block]++] = e;
  }
  void each_bilateral(Index b, auto&& f) const {
    for (Index k = start_[b]; k < start_[b + 1]; ++k) f(sides_[order_[k]]);
  }

  void number_hubs() {
    size_ = bilateral_;
    hub_.assign(blocks_.size(), -1);
    for (std::size_t b = 0; b < blocks_.size(); ++b)
      if (held_[b] > most) hub_[b] = size_, size_ += parts;
  }
  void list_pairs() {
    pairs_.clear();
    for (Index b = 0; b < Index(blocks_.size()); ++b)
      each_bilateral(b, [&](const Side& e) {
        for (int k = 0; hub_[b] >= 0 && k < parts; ++k) pairs_.emplace_back(e.node, hub_[b] + k);
        if (hub_[b] < 0)
          each_bilateral(b, [&](const Side& f) {
            if (e.node < f.node) pairs_.emplace_back(e.node, f.node);
          });
      });
  }
  static void join_hub(auto& A, const Side& e, Index hub) {
    for (int k = 0; k < width; ++k) {
      auto &right = A.at(e.node, hub + k / w), &below = A.at(hub + k / w, e.node);
      for (int j = 0; j < w; ++j) right(j, k % w) += e.H(j, k), below(k % w, j) -= e.G(k, j);
    }
  }

  Index bilateral_ = 0, size_ = 0;
  std::array<Array<Index>, sizeof...(widths)> number_;  ///< of a block of a set here, or −1
  Array<std::pair<int, Index>> blocks_;                 ///< (set, block)
  Array<Node> nodes_;
  Array<Side> sides_;
  Array<Index> start_, order_, next_, held_, hub_;
  Array<std::pair<Index, Index>> pairs_;
  IslandMatrices<SparseLu<w, double>> matrices_;
  SparseLu<w, double>* matrix_ = nullptr;
  Array<Row> x_, step_;
};

}  // namespace delassus::inner
