/// The compliance of chosen nodes: their rows and columns of A⁻¹ from a multifrontal factor of A.
#pragma once

#include <delassus/core/array.hpp>
#include <delassus/core/sort.hpp>
#include <delassus/linear/inner/dense_kernel.hpp>
#include <delassus/linear/supernodes.hpp>
#include <delassus/math/long_vectors.hpp>

#include <algorithm>
#include <cstddef>
#include <span>
#include <utility>

namespace delassus {

/// C = S A⁻¹ Sᵀ, S the rows of the identity that belong to n nodes:
///
///   P A Pᵀ = L Lᵀ,   C = Yᵀ Y,   Y = L⁻¹ P Sᵀ.
///
/// Y is zero but on the paths from the nodes to the roots of the elimination tree, and no more is visited.
/// The nodes are taken in the order of elimination: those below a supernode are then a run, and its part of Y
/// is dense. Its buffers keep their capacity: a warm call with as many nodes allocates nothing. Source: J. R.
/// Gilbert, T. Peierls, "Sparse partial pivoting in time proportional to arithmetic operations" (the reach of
/// a right-hand side).
template <int w, class T>
class NodeCompliance {
 public:
  /// C, (w n) × (w n) numbers by columns, of the nodes, each named once. `factor` offers `pattern()` and
  /// `columns_of(supernode)`.
  void find(const auto& factor, std::span<const Index> nodes, std::span<T> C) {
    const SupernodalPattern& pattern = factor.pattern();
    const Index columns = w * Index(nodes.size());
    find_reach(pattern, nodes);
    if (y_.size() < std::size_t(columns) * rows_) y_.resize(std::size_t(columns) * rows_);
    for (const Index s : visited_) {
      const auto [lo, hi] = wanted_below(pattern.supernodes()[s]);
      for (Index c = 0; c < w * pattern.supernodes()[s].width; ++c)
        std::fill_n(line(pattern.supernodes()[s].first, c, columns, lo), hi - lo, T(0));
    }
    result_.assign(std::size_t(columns) * columns, T(0));
    for (Index k = 0; k < Index(nodes.size()); ++k) {
      const Index place = wanted_[k].first;
      for (int c = 0; c < w; ++c) *line(place, c, columns, w * k + c) = T(1);
    }
    const inner::Columns<T> minus{result_.data(), std::size_t(columns)};
    for (const Index s : visited_) {
      const Supernode& x = pattern.supernodes()[s];
      const auto [lo, hi] = wanted_below(x);
      const inner::Columns<T> Y{line(x.first, 0, columns, lo), std::size_t(columns)};
      forward(x, factor.columns_of(s), Y, minus.from(lo, lo), lo, hi - lo, columns);
    }
    for (Index q = 0; q < Index(nodes.size()); ++q)
      for (Index p = q; p < Index(nodes.size()); ++p) {
        const inner::Columns<T> from = minus.from(w * p, w * q);
        const std::size_t first_row = w * wanted_[p].second, first_column = w * wanted_[q].second;
        for (int c = 0; c < w; ++c)
          for (int r = p == q ? c : 0; r < w; ++r) {
            const std::size_t a = first_row + r, b = first_column + c;
            C[a + b * columns] = C[b + a * columns] = -*from.at(r, c);
          }
      }
  }

 private:

  /// Y ← L⁻¹ Y and −C ← −C − Yᵀ Y, the share of one supernode. Y is stored transposed, one column a row of L,
  /// `used` of its columns from `first` on.
  void forward(const Supernode& x, inner::Columns<const T> L, inner::Columns<T> Y, inner::Columns<T> minus,
               Index first, Index used, Index columns) {
    const Index width = w * x.width, below = w * x.below();
    gather_.resize(std::size_t(used) * below);
    const inner::Columns<T> G{gather_.data(), std::size_t(used)};
    kernel_.solve_and_multiply(Y, L, L.from(width, 0), G, minus, used, below, width);
    for (Index i = 0; i < below; ++i)
      add_multiple<T>(1, G.at(0, i), line(x.rows[x.width + i / w], i % w, columns, first), used);
  }

  /// The wanted nodes by place, the supernodes above them, and where the rows of those are kept.
  void find_reach(const SupernodalPattern& pattern, std::span<const Index> nodes) {
    const auto& supernodes = pattern.supernodes();
    wanted_.clear();
    visited_.clear();
    slot_.assign(pattern.nodes(), -1);
    for (Index k = 0; k < Index(nodes.size()); ++k) wanted_.emplace_back(pattern.place(nodes[k]), k);
    inner::sort(wanted_);
    for (auto [place, k] : wanted_)
      for (Index s = pattern.supernode_of(place); s >= 0 && slot_[supernodes[s].first] < 0;
           s = supernodes[s].parent) {
        slot_[supernodes[s].first] = 0;
        visited_.push_back(s);
      }
    inner::sort(visited_);
    rows_ = 0;
    for (const Index s : visited_)
      for (Index c = 0; c < supernodes[s].width; ++c, rows_ += w) slot_[supernodes[s].first + c] = rows_;
  }
  Index first_wanted(Index place) const {
    return Index(inner::lower_bound(wanted_.data(), wanted_.data() + wanted_.size(), std::pair<Index, Index>(place, -1)) -
                 wanted_.begin());
  }
  /// The columns of Y that begin in a supernode or below it: [first, last).
  std::pair<Index, Index> wanted_below(const Supernode& x) const {
    return {w * first_wanted(x.first_descendant), w * first_wanted(x.first + x.width)};
  }
  T* line(Index place, int c, Index columns, Index at) {
    return &y_[std::size_t(slot_[place] + c) * columns + at];
  }

  inner::DenseKernel<T> kernel_;
  Array<T> y_, gather_, result_;
  Array<std::pair<Index, Index>> wanted_;  ///< (place, number)
  Array<Index> visited_, slot_;
  Index rows_ = 0;
};

}  // namespace delassus
