/// An island of rows, laws and W whose types are known, as the island that a solver takes.
#pragma once

#include <delassus/rows/islands.hpp>
#include <delassus/rows/local.hpp>
#include <delassus/rows/row_system.hpp>
#include <delassus/solvers/island.hpp>

#include <cstddef>
#include <span>
#include <type_traits>

namespace delassus {

/// An observer that wants nothing. One with `every_sweep = true` has each sweep measured, and is called with its number and measure.
struct NoObserver {
  static constexpr bool every_sweep = false;
  void begin_island(Index) const {}
  void operator()(int, const Measure&) const {}
};

namespace inner {

template <class T, class Observer>
struct CallsOfObserver {
  static Observer& of(void* who) { return *static_cast<Observer*>(who); }
  static void sweep(void* who, int sweeps, const Measure& m) { of(who)(sweeps, m); }
  static bool wants_forces(void* who) { return of(who).wants_forces(); }
  static void force(void* who, int sweeps, const PoolView<T>& pool, Index i, double h) {
    const auto R = std::size_t(pool.rows);
    of(who).force(sweeps, pool.pool, i, std::span<const T>(pool.lambda + R * std::size_t(i), R), h);
  }
};

template <class T, class Observer>
SolveObserver<T> show_observer(Observer& observer) {
  using Calls = CallsOfObserver<T, Observer>;
  SolveObserver<T> out{&observer, Observer::every_sweep, Calls::sweep};
  if constexpr (requires { observer.wants_forces(); }) out.wants_forces = Calls::wants_forces, out.force = Calls::force;
  return out;
}

}  // namespace inner

/// Pre: `book` has prepared these rows and this W.
template <class Book, class Rows, class Operator, class Observer = NoObserver>
class IslandProblem : public Island<typename Rows::Scalar> {
 public:
  using T = typename Rows::Scalar;

  IslandProblem(Book& book, Rows&, Operator&, const Islands<T>& islands, Index island, double h, Observer& observer)
      : Island<T>(spans_, 0, island, h) {
    int count = 0;
    for (int p = 0; p < Rows::pool_count; ++p)
      if (const inner::Slice<const Index> items = islands.items(p, island); !items.empty())
        spans_[count++] = {&book.view(p), items.data(), Index(items.size())};
    this->take(spans_, count);
    this->length_ = inner::length_of_island(this->begin(), this->end());
    if constexpr (!std::is_same_v<Observer, NoObserver>) this->set_observer(inner::show_observer<T>(observer));
  }
  /// Who solves it, among those that work at once.
  Index worker = 0;

  IslandProblem(const IslandProblem&) = delete;
  IslandProblem& operator=(const IslandProblem&) = delete;

 private:
  Span<T> spans_[Rows::pool_count > 0 ? Rows::pool_count : 1];
};

}  // namespace delassus
