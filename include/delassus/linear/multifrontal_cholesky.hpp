/// Multifrontal Cholesky factorization of a sparse symmetric positive definite matrix of small square blocks.
#pragma once

#include <delassus/linear/inner/dense_kernel.hpp>
#include <delassus/linear/supernodes.hpp>

#include <algorithm>
#include <cstddef>
#include <span>
#include <utility>
#include <vector>

namespace delassus {

/// P A Pᵀ = L Lᵀ with w × w blocks, P by nested dissection. Every supernode is a dense front: its entries of
/// A plus what its children leave, its columns factored, the rest left to its parent. The pattern is analysed
/// once; from the second time on `factor`, `solve` and `compliance` do not allocate. For some hundred nodes
/// or more; below that `BlockCholesky` does. Source: I. S. Duff, J. K. Reid, "The multifrontal solution of
/// indefinite sparse symmetric linear equations".
template <int w, class T>
class MultifrontalCholesky {
 public:
  using Block = Mat<w, w, T>;

  /// Pattern of the lower triangle: all diagonal blocks and the pairs (i, j), i ≠ j, in any order, repeats
  /// allowed. `positions` is empty or one point a block, m; they make a better order.
  void analyse(Index blocks, std::span<const std::pair<Index, Index>> pairs,
               std::span<const Vec3> positions = {}) {
    std::vector<std::pair<Index, Index>> unique;
    for (auto [i, j] : pairs) unique.emplace_back(std::minmax(i, j));
    std::sort(unique.begin(), unique.end());
    unique.erase(std::unique(unique.begin(), unique.end()), unique.end());
    const NodeGraph graph(blocks, unique);
    pattern_.analyse(graph, NestedDissection{}.order(graph, positions));
    entries_.analyse(graph, pattern_);
    place_fronts();
    diagonal_.resize(blocks);
    lower_.resize(entries_.row.size());
  }

  Index blocks() const { return pattern_.nodes(); }
  /// Numbers stored for L.
  std::size_t size() const { return factor_size_; }

  void set_zero() {
    for (Block& b : diagonal_) b.setZero();
    for (Block& b : lower_) b.setZero();
  }
  /// A_ii += block.
  void add_diagonal(Index i, const Block& block) { diagonal_[pattern_.place(i)] += block; }
  /// A_ij += block and A_ji += blockᵀ, i ≠ j.
  void add_pair(Index i, Index j, const Block& block) {
    const Index row = pattern_.place(i), column = pattern_.place(j);
    if (row > column)
      lower_[entries_.find(row, column)] += block;
    else
      lower_[entries_.find(column, row)] += block.transpose();
  }

  /// Makes the factor of A; false when A is not positive definite or not finite: then nothing may be solved.
  bool factor() {
    factor_.resize(factor_size_);
    updates_.resize(updates_size_);
    for (Index s = 0; s < Index(fronts_.size()); ++s)
      if (!factor_front(s)) return false;
    return true;
  }

  /// x ← A⁻¹ x.
  void solve(std::vector<Vec<w, T>>& x) const {
    y_.resize(std::size_t(w) * blocks());
    for (Index i = 0; i < blocks(); ++i) Line(&y_[w * pattern_.place(i)], w) = x[i].array();
    for (Index s = 0; s < Index(fronts_.size()); ++s) forward(s);
    for (Index s = Index(fronts_.size()); s-- > 0;) backward(s);
    for (Index i = 0; i < blocks(); ++i) x[i] = ConstLine(&y_[w * pattern_.place(i)], w).matrix();
  }

  /// The rows and columns of A⁻¹ of some nodes, each once: C is (w n) × (w n) by columns. A⁻¹_cc = Yᵀ Y, Y =
  /// L⁻¹ E_c, and Y is zero but on the paths from the nodes to the roots of the elimination tree: no more is
  /// visited.
  void compliance(std::span<const Index> nodes, std::span<T> C) const {
    const Index n = Index(nodes.size()), columns = w * n;
    find_reach(nodes);
    y_.assign(std::size_t(columns) * w * reach_.size(), T(0));
    result_.assign(std::size_t(columns) * columns, T(0));
    for (Index k = 0; k < n; ++k)
      for (int c = 0; c < w; ++c) *line(wanted_[k].first, c, columns, w * k + c) = T(1);
    const Columns<T> W{result_.data(), std::size_t(columns)};
    for (const Index s : visited_) {
      const Supernode& x = pattern_.supernodes()[s];
      // Only the wanted nodes of its subtree have anything here.
      const Index lo = w * first_wanted(x.first_descendant), hi = w * first_wanted(x.first + x.width);
      forward(s, {line(x.first, 0, columns, lo), std::size_t(columns)}, lo, hi - lo, columns);
      const Columns<const T> Y{line(x.first, 0, columns, lo), std::size_t(columns)};
      kernel_.subtract(W.from(lo, lo), Y, Y, hi - lo, hi - lo, w * x.width, true);
    }
    for (Index j = 0; j < columns; ++j)
      for (Index i = j; i < columns; ++i) {
        const std::size_t a = w * wanted_[i / w].second + i % w, b = w * wanted_[j / w].second + j % w;
        C[a + b * columns] = C[b + a * columns] = -*W.at(i, j);
      }
  }

 private:
  template <class U>
  using Columns = inner::Columns<U>;
  using Line = Eigen::Map<Eigen::Array<T, Eigen::Dynamic, 1>>;
  using ConstLine = Eigen::Map<const Eigen::Array<T, Eigen::Dynamic, 1>>;

  /// `length` rows of a child, in a run from its row `from`, are the rows of its parent from `to` on.
  struct Run {
    Index from, to, length;
  };
  struct Front {
    std::size_t factor = 0, update = 0;  ///< where its columns of L and its part for the parent are
    std::vector<Run> runs;
  };

  const Supernode& supernode(Index s) const { return pattern_.supernodes()[s]; }

  /// Columns of L one after the other; what is left to parents is a stack, as children stand before parents.
  void place_fronts() {
    fronts_.assign(pattern_.supernodes().size(), {});
    factor_size_ = updates_size_ = 0;
    std::size_t top = 0;
    for (Index s = 0; s < Index(fronts_.size()); ++s) {
      const Supernode& x = supernode(s);
      const std::size_t below = w * x.below();
      fronts_[s].factor = factor_size_;
      factor_size_ += w * x.rows.size() * w * x.width;
      updates_size_ = std::max(updates_size_, top + below * below);
      if (!x.children.empty()) top = fronts_[x.children[0]].update;
      fronts_[s].update = top;
      top += below * below;
      for (Index k = x.width, at = 0; k < Index(x.rows.size()); ++k, ++at) {
        const auto& rows = supernode(x.parent).rows;
        while (rows[at] != x.rows[k]) ++at;
        auto& runs = fronts_[s].runs;
        if (!runs.empty() && runs.back().to + runs.back().length == at)
          ++runs.back().length;
        else
          runs.push_back({k - x.width, at, 1});
      }
    }
  }

  bool factor_front(Index s) {
    const Supernode& x = supernode(s);
    const Index height = w * Index(x.rows.size()), width = w * x.width, below = height - width;
    const Columns<T> L{&factor_[fronts_[s].factor], std::size_t(height)};
    // On top of the children's; moved down to where the first of them was when they are used.
    const std::size_t place = fronts_[s].update;
    std::size_t top = place;
    if (!x.children.empty()) {
      const Index last = x.children.back();
      top = fronts_[last].update + std::size_t(w * supernode(last).below()) * (w * supernode(last).below());
    }
    const Columns<T> U{updates_.data() + top, std::size_t(below)};
    std::fill_n(L.data, std::size_t(height) * width, T(0));
    std::fill_n(U.data, std::size_t(below) * below, T(0));
    enter(x, L);
    for (const Index child : x.children) add_child(child, L, U, width);
    if (!kernel_.factor(L, height, width)) return false;
    const Columns<const T> L21{L.at(width, 0), L.stride};
    kernel_.subtract(U, L21, L21, below, below, width, true);
    if (top != place) std::copy_n(U.data, std::size_t(below) * below, updates_.data() + place);
    return true;
  }

  /// A's own entries of the front's columns.
  void enter(const Supernode& x, Columns<T> L) const {
    for (Index c = 0; c < x.width; ++c) {
      const Index j = x.first + c;
      put(L.from(w * c, w * c), diagonal_[j]);
      for (Index e = entries_.start[j], at = c; e < entries_.start[j + 1]; ++e) {
        while (x.rows[at] != entries_.row[e]) ++at;
        put(L.from(w * at, w * c), lower_[e]);
      }
    }
  }
  static void put(Columns<T> to, const Block& block) {
    for (int c = 0; c < w; ++c) std::copy_n(block.data() + w * c, w, to.at(0, c));
  }

  /// L and U += what a child left, lower triangles.
  void add_child(Index child, Columns<T> L, Columns<T> U, Index width) const {
    const Front& front = fronts_[child];
    const Index below = w * supernode(child).below();
    const T* from = updates_.data() + front.update;
    for (std::size_t b = 0; b < front.runs.size(); ++b)
      for (Index c = 0; c < w * front.runs[b].length; ++c) {
        const Index column = w * front.runs[b].to + c;
        const T* source = from + std::size_t(w * front.runs[b].from + c) * below;
        T* target = column < width ? L.at(0, column) : U.at(0, column - width) - width;
        for (std::size_t a = b; a < front.runs.size(); ++a) {
          const Index skip = a == b ? c : 0, length = w * front.runs[a].length - skip;
          Line(target + w * front.runs[a].to + skip, length) +=
              ConstLine(source + w * front.runs[a].from + skip, length);
        }
      }
  }

  Columns<const T> columns_of(Index s) const {
    return {&factor_[fronts_[s].factor], std::size_t(w) * supernode(s).rows.size()};
  }

  /// y ← L⁻¹ y, the share of one supernode; rows are gathered so that columns of L are read from end to end.
  void forward(Index s) const {
    const Supernode& x = supernode(s);
    const Index height = w * Index(x.rows.size()), width = w * x.width;
    const Columns<const T> L = columns_of(s);
    gather_.assign(height, T(0));
    std::copy_n(&y_[w * x.first], width, gather_.begin());
    for (Index j = 0; j < width; ++j) {
      const T y = gather_[j] /= *L.at(j, j);
      Line(gather_.data() + j + 1, height - j - 1) -= y * ConstLine(L.at(j, j) + 1, height - j - 1);
    }
    std::copy_n(gather_.begin(), width, &y_[w * x.first]);
    for (Index k = x.width; k < Index(x.rows.size()); ++k)
      for (int c = 0; c < w; ++c) y_[w * x.rows[k] + c] += gather_[w * k + c];
  }
  /// y ← L⁻ᵀ y.
  void backward(Index s) const {
    const Supernode& x = supernode(s);
    const Index height = w * Index(x.rows.size());
    const Columns<const T> L = columns_of(s);
    gather_.resize(height);
    for (Index k = 0; k < Index(x.rows.size()); ++k)
      for (int c = 0; c < w; ++c) gather_[w * k + c] = y_[w * x.rows[k] + c];
    for (Index j = w * x.width; j-- > 0;) {
      const Index rest = height - j - 1;
      const T below = (ConstLine(L.at(j, j) + 1, rest) * ConstLine(gather_.data() + j + 1, rest)).sum();
      gather_[j] = (gather_[j] - below) / *L.at(j, j);
    }
    std::copy_n(gather_.begin(), w * x.width, &y_[w * x.first]);
  }
  /// The same for many right-hand sides: Y is the transpose, one column a row of L, `used` of them from
  /// `first` on.
  void forward(Index s, Columns<T> Y, Index first, Index used, Index columns) const {
    const Supernode& x = supernode(s);
    const Index width = w * x.width, below = w * x.below();
    const Columns<const T> L = columns_of(s);
    kernel_.solve_right(Y, L, used, width);
    gather_.assign(std::size_t(used) * below, T(0));
    const Columns<T> G{gather_.data(), std::size_t(used)};
    kernel_.subtract(G, {Y.data, Y.stride}, L.from(width, 0), used, below, width, false);
    for (Index i = 0; i < below; ++i)
      Line(line(x.rows[x.width + i / w], i % w, columns, first), used) += ConstLine(G.at(0, i), used);
  }

  /// The wanted nodes by place, the supernodes above them, and where the places of those are kept.
  void find_reach(std::span<const Index> nodes) const {
    wanted_.clear();
    visited_.clear();
    reach_.clear();
    slot_.assign(blocks(), -1);
    for (Index k = 0; k < Index(nodes.size()); ++k) wanted_.emplace_back(pattern_.place(nodes[k]), k);
    std::sort(wanted_.begin(), wanted_.end());
    for (auto [place, k] : wanted_)
      for (Index s = pattern_.supernode_of(place); s >= 0 && slot_[supernode(s).first] < 0;
           s = supernode(s).parent) {
        slot_[supernode(s).first] = 0;
        visited_.push_back(s);
      }
    std::sort(visited_.begin(), visited_.end());
    for (const Index s : visited_)
      for (Index c = 0; c < supernode(s).width; ++c) {
        slot_[supernode(s).first + c] = Index(reach_.size());
        reach_.push_back(supernode(s).first + c);
      }
  }
  Index first_wanted(Index place) const {
    return Index(std::lower_bound(wanted_.begin(), wanted_.end(), std::pair<Index, Index>(place, -1)) -
                 wanted_.begin());
  }
  T* line(Index place, int c, Index columns, Index at) const {
    return &y_[(std::size_t(slot_[place]) * w + c) * columns + at];
  }

  SupernodalPattern pattern_;
  std::vector<Front> fronts_;
  LowerEntries entries_;
  std::vector<Block> diagonal_, lower_;
  std::size_t factor_size_ = 0, updates_size_ = 0;
  std::vector<T> factor_, updates_;
  mutable inner::DenseKernel<T> kernel_;
  mutable std::vector<T> y_, gather_, result_;
  mutable std::vector<std::pair<Index, Index>> wanted_;  ///< (place, number)
  mutable std::vector<Index> visited_, reach_, slot_;
};

}  // namespace delassus
