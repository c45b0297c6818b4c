/// Warm start: every constraint begins with the impulse it had, scaled with the step.
#pragma once

#include <delassus/core/cmath.hpp>
#include <delassus/core/owning_array.hpp>
#include <delassus/core/ranges.hpp>
#include <delassus/core/slice.hpp>
#include <delassus/rows/islands.hpp>
#include <delassus/solvers/inner/length_of_island.hpp>
#include <delassus/solvers/law_table.hpp>
#include <delassus/solvers/solve_report.hpp>
#include <delassus/step/contact_cache.hpp>
#include <delassus/step/law_rows.hpp>

#include <algorithm>
#include <cstddef>
#include <limits>

namespace delassus {

/// λ ← h/h_last · λ of the last step, by contact id or by item. Contacts carry theirs as a world vector, brought back
/// into the cone of the new frame. Arguments h and last_h are this step and the last one, s.
template <class T>
void warm_start(AllLaws<T> laws, AllRows<T> rows, ContactCache& cache, double h, double last_h) {
  for (std::size_t p = 0; p < laws.size(); ++p)
    laws[p].law->warm_start(laws[p].pool, rows[p], {0, laws[p].law->count(laws[p].pool)}, cache, cache.search(), h / last_h, h);
}

/// The same by several workers, each with one of the `searches`.
template <class T, class E>
void warm_start(AllLaws<T> laws, AllRows<T> rows, ContactCache& cache, double h, double last_h, OwningArray<ContactCache::Search>& searches,
                const E& execution) {
  for (std::size_t p = 0; p < laws.size(); ++p) {
    const LawPool<T>& law = laws[p];
    const Index count = law.law->count(law.pool), tasks = inner::tasks_of(count, 128, execution.workers());
    searches.resize(std::size_t(tasks));
    const auto start = [&](inner::Range range, ContactCache::Search& search) {
      law.law->warm_start(law.pool, rows[p], range, cache, search, h / last_h, h);
    };
    if (tasks == 1) {
      start({0, count}, cache.search());
      continue;
    }
    execution.run(tasks, [&](Index task, Index) {
      inner::Range range = inner::range_of(count, task, tasks);
      range = {law.law->next_pair(law.pool, range.first, cache), law.law->next_pair(law.pool, range.last, cache)};
      ContactCache::Search& search = searches[std::size_t(task)];
      cache.begin(search);
      start(range, search);
    });
  }
}

/// Hands the impulses back: to the items of the pools, and to the contacts as world vectors.
template <class T>
void keep_impulses(AllLaws<T> laws, AllRows<T> rows, ContactCache& cache) {
  for (std::size_t p = 0; p < laws.size(); ++p) laws[p].law->keep_impulses(laws[p].pool, rows[p], {0, laws[p].law->count(laws[p].pool)}, cache);
}
/// The same where `ranges` says who does which items.
template <class T, class Ranges>
void keep_impulses(AllLaws<T> laws, AllRows<T> rows, ContactCache& cache, const Ranges& ranges) {
  for (std::size_t p = 0; p < laws.size(); ++p)
    ranges(laws[p].law->count(laws[p].pool), 256, [&](inner::Range range) { laws[p].law->keep_impulses(laws[p].pool, rows[p], range, cache); });
}

namespace inner {

/// Impulses beyond every load are no start for the next step: those of constraints that contradict each other would grow
/// from step to step without bound. A chain of n constraints between bodies whose compliances span r = max w/min w carries
///
///   |w λ_i| ≤ n r max |d|,   w the weights of the rows,
///
/// at most. Rows in rad/s count at the island's length.
struct ImpulseLoads {
  double least = std::numeric_limits<double>::infinity(), most = 0, load = 0, response = 0;
  long count = 0;

  /// `w` by row; bit k of `turns`: row k is in rad/s.
  template <class T>
  void add(const double* w, const T* d, const T* lambda, int rows, unsigned turns, double length) {
    double of_d = 0, of_lambda = 0, mean = 0;
    for (int k = 0; k < rows; ++k) {
      const double scale = turns >> k & 1 ? length : 1, x = scale * double(d[k]), y = scale * w[k] * double(lambda[k]);
      of_d += x * x, of_lambda += y * y, mean += scale * scale * w[k] / rows;
    }
    least = std::min(least, mean);
    most = std::max(most, mean);
    load = std::max(load, std::sqrt(of_d));
    response = std::max(response, std::sqrt(of_lambda));
    ++count;
  }
  bool are_exceeded() const { return !(response * least <= double(count) * most * load); }
};

}  // namespace inner

/// An island whose solve ended far from its laws and with impulses beyond every load starts from zero.
template <class T>
void forget_lost_islands(AllLaws<T> laws, inner::Slice<const PoolView<T>> rows, ContactCache& cache, const Islands<T>& islands,
                         inner::Slice<const SolveReport> reports) {
  constexpr double far = 0.05;  // of the largest velocity of the island
  for (Index k = 0; k < islands.count(); ++k) {
    if (reports[k].status < Status::max_iterations || reports[k].measure.residual <= far) continue;
    inner::LengthOfRows length;
    for (std::size_t p = 0; p < laws.size(); ++p)
      for (const Index i : islands.items(int(p), k)) length.add(rows[p], i);
    inner::ImpulseLoads loads;
    for (std::size_t p = 0; p < laws.size(); ++p)
      for (const Index i : islands.items(int(p), k)) {
        double w[most_rows];
        rows[p].weights(i, w);
        loads.add(w, rows[p].d + rows[p].rows * i, rows[p].lambda + rows[p].rows * i, rows[p].rows, rows[p].turns, length.length());
      }
    if (!loads.are_exceeded()) continue;
    for (std::size_t p = 0; p < laws.size(); ++p)
      for (const Index i : islands.items(int(p), k)) laws[p].law->forget(laws[p].pool, i, cache);
  }
}

}  // namespace delassus
