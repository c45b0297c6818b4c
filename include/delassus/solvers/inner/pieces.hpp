/// A pass over an island in pieces of a fixed number of items, which several threads may share.
#pragma once

#include <delassus/core/array.hpp>
#include <delassus/core/crew.hpp>
#include <delassus/core/index.hpp>
#include <delassus/solvers/law_table.hpp>
#include <delassus/solvers/measure.hpp>

#include <algorithm>
#include <cstddef>

namespace delassus::inner {

inline void add_sums(MeasureSums& to, const MeasureSums& x) {
  for (double MeasureSums::*sum : {&MeasureSums::residual, &MeasureSums::siconos, &MeasureSums::d,
                                   &MeasureSums::u, &MeasureSums::lambda, &MeasureSums::closing})
    to.*sum += x.*sum;
  to.worst = std::max(to.worst, x.worst);
  to.reach = std::max(to.reach, x.reach);
}
template <class T>
void add_sums(Sweep<T>& to, const Sweep<T>& x) {
  to.energy += x.energy, to.along += x.along, to.displacement += x.displacement;
  to.most = std::max(to.most, x.most);
}

/// Sums are made by piece and added in order, so that they do not depend on who made which. Items of a span
/// must not meet each other in W where they are changed.
template <class T>
class Pieces {
 public:
  /// Null: one thread.
  Crew* crew = nullptr;

  /// f(piece, its first row, sums) for all pieces of the spans; `start` are sums of nothing.
  template <class Sums, class F>
  Sums pass(const Span<T>* first, const Span<T>* last, const Sums& start, Array<Sums>& sums, const F& f) {
    Sums all = start;
    Index row = 0;
    for (const Span<T>* span = first; span != last; ++span) {
      const Index count = (span->count + items - 1) / items, R = span->pool->rows;
      sums.assign(std::size_t(count), start);
      const auto visit = [&](Index k) {
        const Index at = k * items;
        const Span<T> piece{span->pool, span->items + at, std::min(span->count - at, items)};
        f(piece, row + at * R, sums[std::size_t(k)]);
      };
      if (crew)
        crew->run(count, visit);
      else
        for (Index k = 0; k < count; ++k) visit(k);
      for (const Sums& one : sums) add_sums(all, one);
      row += span->count * R;
    }
    return all;
  }

  Array<Sweep<T>> sweeps;
  Array<MeasureSums> measures;

 private:
  static constexpr Index items = 32;  ///< of a piece: some microseconds
};

}  // namespace delassus::inner
