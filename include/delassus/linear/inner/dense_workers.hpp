/// Dense columns factored and multiplied by several workers, with the bits of one.
#pragma once

#include <delassus/core/array.hpp>
#include <delassus/core/cmath.hpp>
#include <delassus/core/index.hpp>
#include <delassus/core/owning_array.hpp>
#include <delassus/core/ranges.hpp>
#include <delassus/linear/inner/dense_kernel.hpp>

#include <algorithm>
#include <cstddef>
#include <numeric>

namespace delassus::inner {

/// Rows of a lower triangle with `count` of them, shares of one area.
inline Range range_of_triangle(Index count, Index task, Index tasks) {
  const auto bound = [&](Index k) {
    return k == tasks ? count : Index(double(count) * std::sqrt(double(k) / double(tasks)) + 0.5);
  };
  return {bound(task), bound(task + 1)};
}

/// A `DenseKernel` for each worker. Rows are cut where a kernel that has them all begins a strip and a panel:
/// each number is then made by the same tile.
template <class T>
class DenseWorkers {
  using Kernel = DenseKernel<T>;

 public:
  /// What one of them keeps.
  struct Worker {
    Kernel kernel;
    Array<T> gather;
  };

  /// For so many, and matrices with so many rows: nothing is allocated after.
  void prepare(Index workers, Index rows, std::size_t gathered) {
    of_.resize(std::size_t(workers));
    for (Worker& one : of_) {
      one.kernel.reserve(rows);
      if (one.gather.size() < gathered) one.gather.resize(gathered);
    }
  }
  Worker& operator[](Index worker) { return of_[std::size_t(worker)]; }

  /// `DenseKernel::factor`.
  template <class E>
  bool factor(Columns<T> C, Index m, Index columns, const E& execution) {
    if (!factor_square(C, columns, execution)) return false;
    solve_right(C.from(columns, 0), {C.data, C.stride}, m - columns, columns, execution);
    return true;
  }
  /// C = −A Aᵀ, entries i ≥ j: C is m × m, A is m × k.
  template <class E>
  void negated_square(Columns<T> C, Columns<const T> A, Index m, Index k, const E& execution) {
    each_share_of_triangle(m, k, execution, [&](Index first, Index last, Kernel& kernel) {
      kernel.negated_product(C.from(first, 0), A.from(first, 0), A, last - first, first, k, false);
      kernel.negated_product(C.from(first, first), A.from(first, 0), A.from(first, 0), last - first,
                             last - first, k, true);
    });
  }

 private:
  static constexpr Index least = 128;          ///< columns of a square that are worth sharing
  static constexpr double least_work = 1.5e5;  ///< products that are worth a task
  static constexpr Index grain = std::lcm(Kernel::strip, Kernel::panel);

  /// f(first, last, kernel) for shares of m rows that cost `work` products each.
  template <class E, class F>
  void each_share(Index m, double work, const E& execution, const F& f) {
    const Index grains = (m + grain - 1) / grain,
                worth = std::max(Index(1), Index(std::min(1e6, least_work / (work * grain)))),
                tasks = tasks_of(grains, worth, execution.workers());
    execution.run(tasks, [&](Index task, Index worker) {
      const Range range = range_of(grains, task, tasks);
      f(range.first * grain, std::min(m, range.last * grain), (*this)[worker].kernel);
    });
  }
  /// The same of the lower triangle of m rows with k products an entry: shares of one area.
  template <class E, class F>
  void each_share_of_triangle(Index m, Index k, const E& execution, const F& f) {
    const Index grains = (m + grain - 1) / grain;
    const double work = 0.5 * double(m) * m * k;
    const Index tasks =
        std::min(grains, tasks_of(Index(std::min(1e6, work / least_work)), 1, execution.workers()));
    execution.run(tasks, [&](Index task, Index worker) {
      const Range range = range_of_triangle(grains, task, tasks);
      const Index first = range.first * grain, last = std::min(m, range.last * grain);
      if (first < last) f(first, last, (*this)[worker].kernel);
    });
  }

  template <class E>
  void solve_right(Columns<T> Y, Columns<const T> L, Index m, Index k, const E& execution) {
    if (m == 0) return;
    each_share(m, 0.5 * double(k) * k, execution, [&](Index first, Index last, Kernel& kernel) {
      kernel.solve_right(Y.from(first, 0), L, last - first, k);
    });
  }
  /// By halves, as `DenseKernel` does it.
  template <class E>
  bool factor_square(Columns<T> C, Index n, const E& execution) {
    if (n <= least) return (*this)[0].kernel.factor_square(C, n);
    const Index half = Kernel::half_of(n), rest = n - half;
    if (!factor_square(C, half, execution)) return false;
    solve_right(C.from(half, 0), {C.data, C.stride}, rest, half, execution);
    const Columns<const T> below{C.at(half, 0), C.stride};
    const Columns<T> right = C.from(half, half);
    each_share_of_triangle(rest, half, execution, [&](Index first, Index last, Kernel& kernel) {
      kernel.subtract(right.from(first, 0), below.from(first, 0), below, last - first, first, half, false);
      kernel.subtract(right.from(first, first), below.from(first, 0), below.from(first, 0), last - first,
                      last - first, half, true);
    });
    return factor_square(right, rest, execution);
  }

  OwningArray<Worker> of_;
};

}  // namespace delassus::inner
