/// Warm start: every constraint begins with the impulse it had, scaled with the step.
#pragma once

#include <delassus/core/cmath.hpp>
#include <delassus/core/slice.hpp>
#include <delassus/rows/islands.hpp>
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
  for (std::size_t p = 0; p < laws.size(); ++p) laws[p].law->warm_start(laws[p].pool, rows[p], cache, h / last_h, h);
}

/// Hands the impulses back: to the items of the pools, and to the contacts as world vectors.
template <class T>
void keep_impulses(AllLaws<T> laws, AllRows<T> rows, ContactCache& cache) {
  for (std::size_t p = 0; p < laws.size(); ++p) laws[p].law->keep_impulses(laws[p].pool, rows[p], cache);
}

namespace inner {

/// Impulses beyond every load are no start for the next step: those of constraints that contradict each other would grow
/// from step to step without bound. A chain of n constraints between bodies whose compliances span r = max w/min w carries
///
///   w_i |λ_i| ≤ n r max |d|,   w = tr(W_ii)/rows,
///
/// at most.
struct ImpulseLoads {
  double least = std::numeric_limits<double>::infinity(), most = 0, load = 0, response = 0;
  long count = 0;

  template <class T>
  void add(double w, const T* d, const T* lambda, int rows) {
    T of_d = 0, of_lambda = 0;
    for (int k = 0; k < rows; ++k) of_d += d[k] * d[k], of_lambda += lambda[k] * lambda[k];
    least = std::min(least, w);
    most = std::max(most, w);
    load = std::max(load, double(std::sqrt(of_d)));
    response = std::max(response, w * double(std::sqrt(of_lambda)));
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
    inner::ImpulseLoads loads;
    for (std::size_t p = 0; p < laws.size(); ++p)
      for (const Index i : islands.items(int(p), k))
        loads.add(rows[p].weight(i), rows[p].d + rows[p].rows * i, rows[p].lambda + rows[p].rows * i, rows[p].rows);
    if (!loads.are_exceeded()) continue;
    for (std::size_t p = 0; p < laws.size(); ++p)
      for (const Index i : islands.items(int(p), k)) laws[p].law->forget(laws[p].pool, i, cache);
  }
}

}  // namespace delassus
