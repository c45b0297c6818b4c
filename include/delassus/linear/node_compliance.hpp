/// The compliance of chosen nodes: their rows and columns of A⁻¹ from a multifrontal factor of A.
#pragma once

#include <delassus/core/array.hpp>
#include <delassus/core/ranges.hpp>
#include <delassus/core/sort.hpp>
#include <delassus/linear/inner/dense_kernel.hpp>
#include <delassus/linear/inner/dense_workers.hpp>
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
    begin(pattern, nodes);
    const inner::Columns<T> minus{result_.data(), std::size_t(columns)};
    for (const Index s : visited_) {
      const Supernode& x = pattern.supernodes()[s];
      const auto [lo, hi] = wanted_below(x);
      const inner::Columns<T> Y{line(x.first, 0, columns, lo), std::size_t(columns)};
      forward(x, factor.columns_of(s), Y, minus.from(lo, lo), lo, hi - lo, columns);
    }
    for (Index q = 0; q < Index(nodes.size()); ++q)
      for (Index p = q; p < Index(nodes.size()); ++p) write(p, q, minus.from(w * p, w * q), C, columns);
  }

  /// The same by several workers, with the same bits. Each makes some columns of Y, then some rows of −C.
  template <class E>
  void find(const auto& factor, std::span<const Index> nodes, std::span<T> C, inner::DenseWorkers<T>& dense,
            const E& execution) {
    const SupernodalPattern& pattern = factor.pattern();
    const Index count = Index(nodes.size()), columns = w * count,
                tasks = inner::tasks_of(count, least_nodes, execution.workers());
    reach(pattern, nodes);
    Index below = 0;
    for (const Index s : visited_) below = std::max(below, w * pattern.supernodes()[s].below());
    const Index largest = w * inner::range_of(count, tasks - 1, tasks).count();
    dense.prepare(execution.workers(), columns, std::size_t(largest) * below);
    result_.resize(std::size_t(columns) * columns);
    execution.run(tasks, [&](Index task, Index worker) {
      const inner::Range mine = inner::range_of(count, task, tasks);
      each_visited(pattern, mine, [&](const Supernode& x, Index, Index, Index first, Index used) {
        clear_some(x, first, used, columns);
      });
      enter(mine.first, mine.last, columns);
      each_visited(pattern, mine, [&](const Supernode& x, Index s, Index, Index first, Index used) {
        solve_some(x, factor.columns_of(s), first, used, columns, dense[worker]);
      });
    });
    const inner::Columns<T> minus{result_.data(), std::size_t(columns)};
    execution.run(tasks, [&](Index task, Index worker) {
      const inner::Range mine = inner::range_of_triangle(count, task, tasks);
      for (Index q = 0; q < w * mine.last; ++q)
        std::fill_n(minus.at(w * mine.first, q), w * mine.count(), T(0));
      each_visited(pattern, mine, [&](const Supernode& x, Index, Index lo, Index first, Index used) {
        subtract_some(x, minus, lo, first, used, columns, dense[worker].kernel);
      });
      for (Index q = 0; q < mine.last; ++q)
        for (Index p = std::max(q, mine.first); p < mine.last; ++p)
          write(p, q, minus.from(w * p, w * q), C, columns);
    });
  }

 private:
  static constexpr Index least_nodes = 6;  ///< whose columns are worth a task

  /// Room for Y and −C, and Sᵀ in it.
  [[gnu::always_inline]] void begin(const SupernodalPattern& pattern, std::span<const Index> nodes) {
    const Index columns = w * Index(nodes.size());
    reach(pattern, nodes);
    for (const Index s : visited_) {
      const auto [lo, hi] = wanted_below(pattern.supernodes()[s]);
      clear_some(pattern.supernodes()[s], lo, hi - lo, columns);
    }
    result_.assign(std::size_t(columns) * columns, T(0));
    enter(0, Index(nodes.size()), columns);
  }
  [[gnu::always_inline]] void reach(const SupernodalPattern& pattern, std::span<const Index> nodes) {
    find_reach(pattern, nodes);
    const std::size_t size = std::size_t(w) * nodes.size() * std::size_t(rows_);
    if (y_.size() < size) y_.resize(size);
  }
  /// Y = 0, some columns of a supernode's rows.
  [[gnu::always_inline]] void clear_some(const Supernode& x, Index first, Index used, Index columns) {
    for (Index c = 0; c < w * x.width; ++c) std::fill_n(line(x.first, c, columns, first), used, T(0));
  }
  /// Y += Sᵀ, the columns of some nodes.
  [[gnu::always_inline]] void enter(Index first, Index last, Index columns) {
    for (Index k = first; k < last; ++k) {
      const Index place = wanted_[k].first;
      for (int c = 0; c < w; ++c) *line(place, c, columns, w * k + c) = T(1);
    }
  }
  /// Block (p, q) of C in the order of the nodes, and its mirror, p ≥ q in the order of elimination.
  [[gnu::always_inline]] void write(Index p, Index q, inner::Columns<T> from, std::span<T> C,
                                    Index columns) const {
    const std::size_t first_row = w * wanted_[p].second, first_column = w * wanted_[q].second;
    for (int c = 0; c < w; ++c)
      for (int r = p == q ? c : 0; r < w; ++r) {
        const std::size_t a = first_row + r, b = first_column + c;
        C[a + b * columns] = C[b + a * columns] = -*from.at(r, c);
      }
  }

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

  /// f(x, its number, lo, first, used) for the supernodes that some of the nodes reach: Y of x has the
  /// columns from lo on, and `used` of them, from `first` on, are of these nodes.
  void each_visited(const SupernodalPattern& pattern, inner::Range nodes, const auto& f) const {
    for (const Index s : visited_) {
      const Supernode& x = pattern.supernodes()[s];
      const auto [lo, hi] = wanted_below(x);
      const Index first = std::max(lo, w * nodes.first), used = std::min(hi, w * nodes.last) - first;
      if (used > 0) f(x, s, lo, first, used);
    }
  }
  /// `forward` of some columns, without the product.
  void solve_some(const Supernode& x, inner::Columns<const T> L, Index first, Index used, Index columns,
                  typename inner::DenseWorkers<T>::Worker& by) {
    const Index width = w * x.width, below = w * x.below();
    const inner::Columns<T> Y{line(x.first, 0, columns, first), std::size_t(columns)},
        G{by.gather.data(), std::size_t(used)};
    by.kernel.solve_right(Y, L, used, width);
    if (below == 0) return;
    by.kernel.negated_product(G, {Y.data, Y.stride}, L.from(width, 0), used, below, width, false);
    for (Index i = 0; i < below; ++i)
      add_multiple<T>(1, G.at(0, i), line(x.rows[x.width + i / w], i % w, columns, first), used);
  }
  /// −C ← −C − Yᵀ Y, some rows of it.
  void subtract_some(const Supernode& x, inner::Columns<T> minus, Index lo, Index first, Index used,
                     Index columns, inner::DenseKernel<T>& kernel) {
    const std::size_t stride = std::size_t(columns);
    const inner::Columns<const T> all{line(x.first, 0, columns, lo), stride},
        mine{line(x.first, 0, columns, first), stride};
    const Index width = w * x.width;
    kernel.subtract(minus.from(first, lo), mine, all, used, first - lo, width, false);
    kernel.subtract(minus.from(first, first), mine, mine, used, used, width, true);
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
    return Index(inner::lower_bound(wanted_.data(), wanted_.data() + wanted_.size(),
                                    std::pair<Index, Index>(place, -1)) -
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
