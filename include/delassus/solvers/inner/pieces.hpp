/// Passes over an island in pieces of a fixed number of items, which several threads may share.
#pragma once

#include <delassus/core/array.hpp>
#include <delassus/core/crew.hpp>
#include <delassus/core/index.hpp>
#include <delassus/solvers/inner/colouring.hpp>
#include <delassus/solvers/island.hpp>
#include <delassus/solvers/law_table.hpp>
#include <delassus/solvers/measure.hpp>

#include <algorithm>
#include <atomic>
#include <cstddef>
#include <thread>

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
class Pieces : public Passes<T> {
 public:
  Pieces() : Passes<T>{sweep, measure, extrapolate} {}

 private:
  static void sweep(Passes<T>* self, const Island<T>& island, const SweepRule& rule, const T* x,
                    Sweep<T>& all) {
    Pieces& own = *static_cast<Pieces*>(self);
    own.pass(island, all, own.sweeps_, [&](const Span<T>& piece, Index row, Sweep<T>& to) {
      if (x) to.x = x + row;
      rule.loop_of(*piece.pool->table)(piece, to);
    });
  }
  static void measure(Passes<T>* self, const Island<T>& island, MeasureSums& all) {
    Pieces& own = *static_cast<Pieces*>(self);
    own.pass(island, all, own.measures_,
             [](const Span<T>& piece, Index, MeasureSums& to) { piece.pool->table->measure(piece, to); });
  }
  static void extrapolate(Passes<T>* self, const Island<T>& island, T* before, T beta) {
    Pieces& own = *static_cast<Pieces*>(self);
    Sweep<T> nothing;
    own.pass(island, nothing, own.sweeps_, [&](const Span<T>& piece, Index row, Sweep<T>&) {
      piece.pool->table->extrapolate(piece, before + row, beta);
    });
  }

  /// f(piece, its first row, sums) for all pieces of the spans; `all` are sums of nothing, and become those
  /// of all.
  template <class Sums, class F>
  void pass(const Island<T>& island, Sums& all, Array<Sums>& sums, const F& f) {
    const Sums start = all;
    Index row = 0;
    for (const Span<T>& span : island) {
      const Index count = (span.count + items_of_piece - 1) / items_of_piece, R = span.pool->rows;
      sums.assign(std::size_t(count), start);
      const auto visit = [&](Index k) {
        const Index at = k * items_of_piece;
        const Span<T> piece{span.pool, span.items + at, std::min(span.count - at, items_of_piece)};
        f(piece, row + at * R, sums[std::size_t(k)]);
      };
      if (Crew* const crew = island.crew())
        from_both_ends(*crew, count, visit);
      else
        for (Index k = 0; k < count; ++k) visit(k);
      for (const Sums& one : sums) add_sums(all, one);
      row += span.count * R;
    }
  }

  /// f(k) for all k below `count`, from the first on by the crew's leader, from the last on by the others.
  /// Pieces of two colours that lie near each other meet, and impulses that the same thread wrote are near to
  /// it.
  template <class F>
  static void from_both_ends(Crew& crew, Index count, const F& f) {
    Index led = 0;
    alignas(64) std::atomic<Index> helped{0};
    const std::thread::id leader = std::this_thread::get_id();
    crew.run(count, [&](Index) {
      f(std::this_thread::get_id() == leader ? led++
                                             : count - 1 - helped.fetch_add(1, std::memory_order_relaxed));
    });
  }

  Array<Sweep<T>> sweeps_;
  Array<MeasureSums> measures_;
};

}  // namespace delassus::inner
