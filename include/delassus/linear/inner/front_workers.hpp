/// The fronts of a multifrontal Cholesky factorization by several workers: subtrees at once, then together
/// the fronts above them.
#pragma once

#include <delassus/core/array.hpp>
#include <delassus/core/index.hpp>
#include <delassus/core/ranges.hpp>
#include <delassus/linear/inner/dense_workers.hpp>
#include <delassus/linear/inner/front_solve.hpp>
#include <delassus/linear/inner/front_triangle.hpp>
#include <delassus/linear/inner/subtrees.hpp>
#include <delassus/linear/supernodes.hpp>

#include <algorithm>
#include <cstddef>

namespace delassus::inner {

/// What workers keep of one factor, beside what each has for all, a `DenseWorkers`. Every number is a sum of
/// the same terms in the same order as by one worker: children are added in their order, and what a subtree
/// adds to places above it waits until it is its turn.
template <int w, class T>
class FrontWorkers {
 public:
  /// Before all else; anew for another pattern or number of workers.
  void analyse(const FrontPlan& plan, Index workers) {
    trees_.analyse_factor(plan.pattern, w, workers);
    solves_.analyse_solve(plan.pattern, workers);
    stack_.resize(trees_.size_of_parts());
    is_bad_.resize(std::size_t(trees_.count()));
    late_start_.assign(1, 0);
    for (Index t = 0; t < solves_.count(); ++t) {
      std::size_t end = late_start_.back();
      each_late(plan, t,
                [&](Index, Index own, Index rows, std::size_t) { end += std::size_t(w) * (rows - own); });
      late_start_.push_back(end);
    }
    late_.resize(late_start_.back());
  }

  /// `MultifrontalCholesky::factor`.
  template <class E>
  bool factor(const FrontPlan& plan, FrontTriangle<w, T>& L, const auto& diagonal, const auto& below,
              DenseWorkers<T>& dense, const E& execution) {
    L.resize_columns(plan);
    execution.run(trees_.count(), [&](Index t, Index worker) {
      is_bad_[t] = 0;
      for (Index s = trees_[t].first; s <= trees_[t].last && !is_bad_[t]; ++s)
        is_bad_[t] = !L.factor_front(plan, s, diagonal, below, parts(plan), dense[worker].kernel);
    });
    for (const char is : is_bad_)
      if (is) return false;
    for (Index s = 0; s < plan.fronts(); ++s)
      if (trees_.tree_of(s) < 0 && !factor_together(plan, L, s, diagonal, below, dense, execution))
        return false;
    return true;
  }

  /// y ← L⁻ᵀ L⁻¹ y, y by places.
  template <class E>
  void solve(const FrontPlan& plan, const FrontTriangle<w, T>& L, T* y, DenseWorkers<T>& dense,
             const E& execution) {
    const auto forward = [&](Index s, Index last_row, T* gather) {
      const Supernode& x = plan.supernode(s);
      solve_forward<w, T>(x, L.columns(plan, s), y, gather);
      add_rows<w>(x, x.width, last_row, gather + w * x.width, y);
    };
    const auto backward = [&](Index s, T* gather) {
      solve_backward<w, T>(plan.supernode(s), L.columns(plan, s), y, gather);
    };
    execution.run(solves_.count(), [&](Index t, Index worker) {
      T* const gather = dense[worker].gather.data();
      each_late(plan, t, [&](Index s, Index own, Index rows, std::size_t late) {
        forward(s, own, gather);
        std::copy(gather + w * own, gather + w * rows, late_.data() + late);
      });
    });
    T* const gather = dense[0].gather.data();
    for (Index s = 0; s < plan.fronts(); ++s) {
      const Index t = solves_.tree_of(s);
      if (t < 0) {
        forward(s, Index(plan.supernode(s).rows.size()), gather);
        continue;
      }
      each_late(plan, t, [&](Index front, Index own, Index rows, std::size_t late) {
        add_rows<w>(plan.supernode(front), own, rows, late_.data() + late, y);
      });
      s = solves_[t].last;
    }
    for (Index s = plan.fronts(); s-- > 0;)
      if (solves_.tree_of(s) < 0) backward(s, gather);
    execution.run(solves_.count(), [&](Index t, Index worker) {
      for (Index s = solves_[t].last; s >= solves_[t].first; --s) backward(s, dense[worker].gather.data());
    });
  }

 private:
  static constexpr double least_work = 3e5;  ///< products of a front that are worth sharing

  /// f(s, own, rows, late) for the fronts of a subtree that one solves with: the rows from `own` on of front
  /// s are places above the subtree, and what it adds to them waits in `late_` from number `late` on.
  void each_late(const FrontPlan& plan, Index tree, const auto& f) {
    const Supernode& top = plan.supernode(solves_[tree].last);
    std::size_t late = late_start_[tree];
    for (Index s = solves_[tree].first; s <= solves_[tree].last; ++s) {
      const auto& rows = plan.supernode(s).rows;
      const Index count = Index(rows.size());
      Index own = count;
      while (own > 0 && rows[own - 1] >= top.first + top.width) --own;
      f(s, own, count, late);
      late += std::size_t(w) * (count - own);
    }
  }
  Columns<T> part(const FrontPlan& plan, Index s) {
    return {stack_.data() + trees_.part(s), std::size_t(w) * plan.supernode(s).below()};
  }
  auto parts(const FrontPlan& plan) {
    return [this, &plan](Index child) { return part(plan, child); };
  }

  /// One front by all workers.
  template <class E>
  bool factor_together(const FrontPlan& plan, FrontTriangle<w, T>& factor, Index s, const auto& diagonal,
                       const auto& entry, DenseWorkers<T>& dense, const E& execution) {
    const Supernode& x = plan.supernode(s);
    const Index height = w * Index(x.rows.size()), width = w * x.width, below = height - width;
    if (double(width) * height * height < least_work)
      return factor.factor_front(plan, s, diagonal, entry, parts(plan), dense[0].kernel);
    const Columns<T> L = factor.columns(plan, s);
    each_range(x.width, execution, [&](Index first, Index last) {
      factor.open_some(plan, s, first, last, L, diagonal, entry, parts(plan));
    });
    if (!dense.factor(L, height, width, execution)) return false;
    if (below == 0) return true;
    dense.negated_square(part(plan, s), {L.at(width, 0), L.stride}, below, width, execution);
    each_range(x.below(), execution, [&](Index first, Index last) {
      factor.pass_on_some(plan, s, first, last, part(plan, s), parts(plan));
    });
    return true;
  }
  /// f(first, last) for shares of the columns of some nodes.
  template <class E>
  static void each_range(Index nodes, const E& execution, const auto& f) {
    const Index tasks = tasks_of(nodes, 8, execution.workers());
    execution.run(tasks, [&](Index task, Index) {
      const Range range = range_of(nodes, task, tasks);
      f(range.first, range.last);
    });
  }

  Subtrees trees_, solves_;  ///< one factors, one solves with
  Array<T> stack_;
  Array<char> is_bad_;  ///< by subtree: its part of A is not positive definite
  Array<T> late_;       ///< what waits for places above, by subtree and front
  Array<std::size_t> late_start_;
};

}  // namespace delassus::inner
