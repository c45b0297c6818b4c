/// The bilateral rows of an island as one sparse matrix, factored whatever their rank.
#pragma once

#include <delassus/core/array.hpp>
#include <delassus/core/cmath.hpp>
#include <delassus/linear/sparse_lu.hpp>
#include <delassus/math/small_products.hpp>
#include <delassus/rows/row_view.hpp>
#include <delassus/solvers/inner/island_matrices.hpp>

#include <algorithm>
#include <cstddef>
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
  int pool, rows;  ///< pool: the number that `take` was given
  Index item, first, last;
  Vec<w> compliance;
  Vec<w> scale;  ///< |W_kk|, 1/kg; zero: nothing answers to the row
};

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
///
/// w: the most rows of a constraint, width: the most velocities of a block.
template <int w_, int width_>
class DirectSystem {
 public:
  static constexpr int w = w_, width = width_;
  static constexpr int most = 5;                     ///< bilateral constraints of a block that is no hub
  static constexpr int parts = (width + w - 1) / w;  ///< nodes of the matrix that a hub takes
  using Row = Vec<w>;
  using Twist = Vec<width>;
  using Node = DirectNode<w>;
  using Side = DirectSide<w, width>;

  void begin() {
    for (const auto& [s, b] : blocks_) number(s, b) = -1;
    blocks_.clear();
    nodes_.clear();
    sides_.clear();
    bilateral_ = 0;
  }

  /// Takes item i of a pool as the next constraint; the bilateral ones come first. False where a set's A
  /// couples blocks.
  template <class T>
  bool take(const RowView<T>& rows, Index i, bool is_bilateral, int pool) {
    const int r = rows.rows;
    Node node{pool, r, i, Index(sides_.size()), 0, zero<Row>(), zero<Row>()};
    for (int s = 0; s < rows.sets; ++s) {
      const SetBlocksView<T>& set = rows.set[s];
      if (!set.has_entries(i)) continue;
      if (!set.G) return false;
      for (Index e = set.offset[i]; e < set.offset[i + 1]; ++e) {
        const std::ptrdiff_t at = std::ptrdiff_t(r * set.width) * e;
        const T *H = set.H + at, *G = set.G + at;
        bool answers = false;
        for (int k = 0; k < r * set.width && !answers; ++k) answers = G[k] != T(0);
        if (!answers) continue;
        Side& side = sides_.emplace_back();
        side.node = Index(nodes_.size());
        side.block = place_of(s, rows.sets, set.block[e]);
        fill(side, H, G, r, set.width);
      }
    }
    node.last = Index(sides_.size());
    measure(node);
    for (int k = 0; k < r; ++k) {
      const std::ptrdiff_t row = std::ptrdiff_t(r) * i + k;
      node.compliance[k] =
          double(rows.compliance[row]) + double(rows.relative_compliance[row]) * node.scale[k];
      node.scale[k] = std::abs(node.scale[k]) + node.compliance[k];
    }
    nodes_.push_back(node);
    if (is_bilateral) ++bilateral_;
    return true;
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
          each_bilateral(b, [&](const Side& f) { add_rows(e, f, A.at(e.node, f.node)); });
      });
    return A.factor(first_row_);
  }

  /// The right side ← −u, where something answers; velocity(node, u) sets u. Returns √Σ u²/W_kk, the size of
  /// it.
  double load(const auto& velocity) {
    clear();
    double square = 0;
    Row u;
    for (Index k = 0; k < bilateral_; ++k) {
      velocity(nodes_[k], u);
      for (int r = 0; r < nodes_[k].rows; ++r) {
        if (!(nodes_[k].scale[r] > 0)) continue;
        x_[k][r] = -u[r];
        square += u[r] * u[r] / nodes_[k].scale[r];
      }
    }
    return std::sqrt(square);
  }
  void clear() {
    for (Row& x : x_) set_all(x, 0.0);
  }
  void set_right_side(Index k, const Row& r) { x_[k] = r; }
  void solve() { matrix_->solve(x_); }
  /// δ of node k after `solve`.
  const Row& answer(Index k) const { return x_[k]; }
  /// Many right sides beside each other, `columns` in a row: their rows, and the first of bilateral
  /// constraint k.
  Index rows() const { return first_row_.back(); }
  Index first_row(Index k) const { return first_row_[k]; }
  void solve(double* X, Index columns) { matrix_->solve(X, columns, first_row_, x_); }
  /// What impulse c of constraint e's side does to a right side, the column at `to`: −H G on neighbours, G on
  /// a hub.
  void disturb(const Side& e, int c, double* to, Index columns) const {
    const auto at = [&](Index block, int r) -> double& {
      return to[std::ptrdiff_t(first_row_[block] + r) * columns];
    };
    if (hub_[e.block] >= 0) {
      for (int k = 0; k < width; ++k) at(hub_[e.block] + k / w, k % w) += e.G(k, c);
    } else {
      each_bilateral(e.block, [&](const Side& f) {
        for (int r = 0; r < nodes_[f.node].rows; ++r) at(f.node, r) -= row_times_column(f.H, r, e.G, c);
      });
    }
  }

  Index bilateral() const { return bilateral_; }
  Index count() const { return Index(nodes_.size()); }
  std::size_t blocks() const { return blocks_.size(); }
  const Node& node(Index k) const { return nodes_[k]; }
  const Side& side(Index e) const { return sides_[e]; }
  bool is_held(Index block) const { return held_[block] > 0; }

 protected:
  Row& right_side(Index k) { return x_[k]; }

  Node& changed_node(Index k) { return nodes_[k]; }
  Side& changed_side(Index e) { return sides_[e]; }
  /// The last bilateral constraint was none. Pre: no other kind was taken.
  void drop_last() {
    sides_.resize(nodes_.back().first);
    nodes_.pop_back();
    --bilateral_;
  }

 private:
  Index& number(int s, Index b) { return number_[std::size_t(b) * std::size_t(sets_) + std::size_t(s)]; }
  Index place_of(int s, int sets, Index b) {
    sets_ = sets;
    if (const std::size_t room = (std::size_t(b) + 1) * std::size_t(sets); number_.size() < room)
      number_.resize(room, -1);
    Index& place = number(s, b);
    if (place < 0) {
      place = Index(blocks_.size());
      blocks_.emplace_back(s, b);
    }
    return place;
  }

  /// H and G as numbers by columns, r rows of H.
  template <class T>
  static void fill(Side& side, const T* H, const T* G, int r, int columns) {
    double *h = side.H.data(), *g = side.G.data();
    for (int k = 0; k < columns; ++k, h += w, H += r)
      for (int j = 0; j < w; ++j) h[j] = j < r ? double(H[j]) : 0;
    std::fill(h, side.H.data() + w * width, 0.0);
    for (int j = 0; j < r; ++j, g += width, G += columns)
      for (int k = 0; k < width; ++k) g[k] = k < columns ? double(G[k]) : 0;
    std::fill(g, side.G.data() + w * width, 0.0);
  }

  /// scale ← the diagonal of Σ H G over the node's own sides.
  void measure(Node& node) const {
    for (Index e = node.first; e < node.last; ++e)
      for (Index f = node.first; f < node.last; ++f)
        if (sides_[e].block == sides_[f].block)
          for (int k = 0; k < node.rows; ++k)
            node.scale[k] += row_times_column(sides_[e].H, k, sides_[f].G, k);
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
    first_row_.assign(1, 0);
    for (Index k = 0; k < size_; ++k)
      first_row_.push_back(first_row_.back() + (k < bilateral_ ? nodes_[k].rows : w));
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
  /// A block += H G of two sides; the rows of H behind its own are zero.
  void add_rows(const Side& e, const Side& f, Mat<w, w>& to) const {
    for (int c = 0; c < nodes_[f.node].rows; ++c) {
      const double* const g = f.G.data() + width * c;
      double* const column = to.data() + w * c;
      double sum[w] = {};
      DELASSUS_UNROLL
      for (int v = 0; v < width; ++v) {
        DELASSUS_UNROLL
        for (int r = 0; r < w; ++r) sum[r] += e.H.data()[r + w * v] * g[v];
      }
      DELASSUS_UNROLL
      for (int r = 0; r < w; ++r) column[r] += sum[r];
    }
  }
  static void join_hub(auto& A, const Side& e, Index hub) {
    for (int k = 0; k < width; ++k) {
      auto &right = A.at(e.node, hub + k / w), &below = A.at(hub + k / w, e.node);
      for (int j = 0; j < w; ++j) right(j, k % w) += e.H(j, k), below(k % w, j) -= e.G(k, j);
    }
  }

  Index bilateral_ = 0, size_ = 0;
  int sets_ = 0;
  Array<Index> number_;                  ///< of a block of a set here, or −1
  Array<std::pair<int, Index>> blocks_;  ///< (set, block)
  Array<Node> nodes_;
  Array<Side> sides_;
  Array<Index> start_, order_, next_, held_, hub_, first_row_;
  Array<std::pair<Index, Index>> pairs_;
  IslandMatrices<SparseLu<w, double>> matrices_;
  SparseLu<w, double>* matrix_ = nullptr;
  Array<Row> x_;
};

}  // namespace delassus::inner
