/// Multifrontal Cholesky factorization of a sparse symmetric positive definite matrix of small square blocks.
#pragma once

#include <delassus/core/expect.hpp>
#include <delassus/linear/inner/dense_kernel.hpp>
#include <delassus/linear/inner/front_layout.hpp>
#include <delassus/linear/node_compliance.hpp>
#include <delassus/linear/supernodes.hpp>

#include <algorithm>
#include <cstddef>
#include <span>
#include <string>
#include <utility>
#include <vector>

namespace delassus {

/// P A Pᵀ = L Lᵀ with w × w blocks, P by nested dissection. Every supernode is a dense front: its entries of
/// A plus what its children leave, its columns factored, the rest left to its parent. The pattern is analysed
/// once; from the second time on `factor`, `refactor`, `solve` and `compliance` do not allocate. For some
/// hundred nodes or more; below that `BlockCholesky` does. Source: I. S. Duff, J. K. Reid, "The multifrontal
/// solution of indefinite sparse symmetric linear equations".
template <int w, class T>
class MultifrontalCholesky {
 public:
  using Block = Mat<w, w, T>;

  /// Pattern of the lower triangle: all diagonal blocks and the pairs (i, j), i ≠ j, in any order, repeats
  /// allowed. `positions` is empty or one point a block, m; they make a better order. The blocks of `region`,
  /// each named once, are eliminated last, so that `refactor` can begin there.
  void analyse(Index blocks, std::span<const std::pair<Index, Index>> pairs,
               std::span<const Vec3> positions = {}, std::span<const Index> region = {}) {
    std::vector<std::pair<Index, Index>> unique;
    for (auto [i, j] : pairs) unique.emplace_back(std::minmax(i, j));
    std::sort(unique.begin(), unique.end());
    unique.erase(std::unique(unique.begin(), unique.end()), unique.end());
    const NodeGraph graph(blocks, unique);
    pattern_.analyse(graph, NestedDissection{}.order(graph, positions, region), Index(region.size()));
    entries_.analyse(graph, pattern_);
    layout_.analyse(pattern_, w);
    A_.resize(blocks + entries_.row.size());
    is_factored_ = false;
    path_.clear();
    for (Index s = 0; s < fronts(); ++s)
      if (pattern_.is_last(supernode(s).first)) path_.emplace_back(s, false);
  }

  Index blocks() const { return pattern_.nodes(); }
  /// Numbers stored for L.
  std::size_t size() const { return layout_.factor_size; }

  void set_zero() {
    for (Block& b : A_) b.setZero();
  }
  /// A_ij = 0 for all i and j among `nodes`, which are of the region: what lies between them is put in anew.
  void set_zero(std::span<const Index> nodes) {
    for (const Index i : nodes) {
      expect_in_region(i);
      for (const Index j : nodes)
        if (const BlockPlace at = find(i, j); at.index >= 0) A_[at.index].setZero();
    }
  }

  /// Where A_ij is kept.
  struct BlockPlace {
    Index index = -1;  ///< −1: nowhere, the pattern does not have it
    bool is_transposed = false;
  };
  /// Looked up once, the places of an element's blocks are a table by which it is added without a search.
  BlockPlace find(Index i, Index j) const {
    const Index row = pattern_.place(i), column = pattern_.place(j);
    if (row == column) return {row, false};
    const Index e = entries_.find(std::max(row, column), std::min(row, column));
    return {e < 0 ? e : blocks() + e, row < column};
  }
  /// A_ij += block, and A_ji += blockᵀ, at the place of (i, j), which the pattern has.
  void add(BlockPlace at, const Block& block) {
    if (at.is_transposed)
      A_[at.index] += block.transpose();
    else
      A_[at.index] += block;
  }
  /// A_ii += block.
  void add_diagonal(Index i, const Block& block) { A_[pattern_.place(i)] += block; }
  /// A_ij += block and A_ji += blockᵀ, i ≠ j.
  void add_pair(Index i, Index j, const Block& block) { add(find(i, j), block); }

  /// Makes the factor of A; false when A is not positive definite or not finite: then nothing may be solved.
  bool factor() {
    factor_.resize(layout_.factor_size);
    stack_.resize(layout_.stack_size);
    kept_.resize(layout_.kept_size);
    is_factored_ = false;
    for (Index s = 0; s < fronts(); ++s)
      if (!factor_front(s)) return false;
    return is_factored_ = true;
  }

  /// The factor again when no blocks A_ij have changed but those with both i and j among `nodes`, which are
  /// of the region: only the fronts on the paths from there to the roots are made anew. Equal to `factor()`
  /// to the bit.
  bool refactor(std::span<const Index> nodes) {
    for (const Index i : nodes) expect_in_region(i);
    if (!is_factored_) return factor();
    is_factored_ = false;
    for (auto& [s, is_changed] : path_) is_changed = false;
    for (const Index i : nodes) is_on_path(pattern_.supernode_of(pattern_.place(i))) = true;
    for (const auto& [s, is_changed] : path_) {
      if (!is_changed) continue;
      if (!factor_front(s)) return false;
      if (supernode(s).parent >= 0) is_on_path(supernode(s).parent) = true;
    }
    return is_factored_ = true;
  }

  /// x ← A⁻¹ x.
  void solve(std::vector<Vec<w, T>>& x) const {
    y_.resize(std::size_t(w) * blocks());
    for (Index i = 0; i < blocks(); ++i) Line(&y_[w * pattern_.place(i)], w) = x[i].array();
    for (Index s = 0; s < fronts(); ++s) forward(s);
    for (Index s = fronts(); s-- > 0;) backward(s);
    for (Index i = 0; i < blocks(); ++i) x[i] = ConstLine(&y_[w * pattern_.place(i)], w).matrix();
  }

  /// The rows and columns of A⁻¹ of some nodes, each named once: C is (w n) × (w n) by columns. See
  /// `NodeCompliance`.
  void compliance(std::span<const Index> nodes, std::span<T> C) const { compliance_.find(*this, nodes, C); }

  const SupernodalPattern& pattern() const { return pattern_; }
  /// The columns of L of a supernode, with its rows.
  inner::Columns<const T> columns_of(Index s) const {
    return {&factor_[layout_.fronts[s].factor], std::size_t(w) * supernode(s).rows.size()};
  }

 private:
  template <class U>
  using Columns = inner::Columns<U>;
  using Line = Eigen::Map<Eigen::Array<T, Eigen::Dynamic, 1>>;
  using ConstLine = Eigen::Map<const Eigen::Array<T, Eigen::Dynamic, 1>>;

  Index fronts() const { return Index(layout_.fronts.size()); }
  const Supernode& supernode(Index s) const { return pattern_.supernodes()[s]; }
  /// Of a supernode of the region.
  bool& is_on_path(Index s) {
    return std::lower_bound(path_.begin(), path_.end(), std::pair(s, false))->second;
  }
  void expect_in_region(Index i) const {
    DELASSUS_EXPECT(
        i >= 0 && i < blocks() && pattern_.is_last(pattern_.place(i)),
        "node " + std::to_string(i) +
            " is to be factored again, but is not in the region that the pattern was analysed with");
  }

  bool factor_front(Index s) {
    const Supernode& x = supernode(s);
    const inner::FrontPlace& front = layout_.fronts[s];
    const Index height = w * Index(x.rows.size()), width = w * x.width, below = height - width;
    const Columns<T> L{&factor_[front.factor], std::size_t(height)};
    const Columns<T> U = part(s);
    std::fill_n(L.data, std::size_t(height) * width, T(0));
    enter(x, L);
    for (const Index child : x.children) add_child(child, L, 0, width);
    if (!kernel_.factor(L, height, width)) return false;
    const Columns<const T> L21{L.at(width, 0), L.stride};
    kernel_.negated_product(U, L21, L21, below, below, width, true);
    for (const Index child : x.children) add_child(child, U, width, height);
    return true;
  }

  Index below_of(Index s) const { return w * supernode(s).below(); }
  /// What a front leaves its parent, (w below) × (w below), lower triangle.
  Columns<T> part(Index s) {
    return {(layout_.fronts[s].is_kept ? kept_ : stack_).data() + layout_.fronts[s].update,
            std::size_t(below_of(s))};
  }

  /// A's own entries of the front's columns.
  void enter(const Supernode& x, Columns<T> L) const {
    for (Index c = 0; c < x.width; ++c) {
      const Index j = x.first + c;
      put(L.from(w * c, w * c), A_[j]);
      for (Index e = entries_.start[j], at = c; e < entries_.start[j + 1]; ++e) {
        while (x.rows[at] != entries_.row[e]) ++at;
        put(L.from(w * at, w * c), A_[blocks() + e]);
      }
    }
  }
  static void put(Columns<T> to, const Block& block) {
    for (int c = 0; c < w; ++c) std::copy_n(block.data() + w * c, w, to.at(0, c));
  }

  /// The front's columns first … last − 1 += what a child left, lower triangle; `to` begins with entry
  /// (first, first).
  void add_child(Index child, Columns<T> to, Index first, Index last) {
    const auto& runs = layout_.fronts[child].runs;
    const Columns<T> from = part(child);
    for (std::size_t b = 0; b < runs.size(); ++b)
      for (Index c = 0; c < w * runs[b].length; ++c) {
        const Index column = w * runs[b].to + c;
        if (column < first || column >= last) continue;
        const T* source = from.at(0, w * runs[b].from + c);
        T* target = to.at(0, column - first) - first;
        for (std::size_t a = b; a < runs.size(); ++a) {
          const Index skip = a == b ? c : 0, length = w * runs[a].length - skip;
          Line(target + w * runs[a].to + skip, length) += ConstLine(source + w * runs[a].from + skip, length);
        }
      }
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

  SupernodalPattern pattern_;
  LowerEntries entries_;
  inner::FrontLayout layout_;
  std::vector<Block> A_;  ///< the diagonal blocks by place, then those below by entry
  std::vector<T> factor_, stack_, kept_;
  std::vector<std::pair<Index, bool>> path_;  ///< the supernodes of the region; true: has to be made anew
  bool is_factored_ = false;
  inner::DenseKernel<T> kernel_;
  mutable NodeCompliance<w, T> compliance_;
  mutable std::vector<T> y_, gather_;
};

}  // namespace delassus
