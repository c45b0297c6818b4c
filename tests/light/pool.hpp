/// All items of one law as plain code sees them, and the two tables through which it reaches the law.
#pragma once

#include "row_writer.hpp"

#include <delassus/solvers/measure.hpp>

namespace light {

template <class T>
struct Pool;
template <class T>
class Delassus;

/// Some items of a pool, ascending, and what a law's loop reads of W and λ. All arrays but `items` are the
/// whole pool's, R numbers an item, R × R a block, by columns.
template <class T>
struct Span {
  const Index* items;  ///< counted in the pool
  Index count;
  const T* base;      ///< d plus what the impulses of all other pools add: they stand still in the meantime
  const T* diagonal;  ///< W_ii
  const Index *start, *column;
  const T* block;  ///< W between items of this pool
  T* lambda;
  Delassus<T>* velocities;  ///< where some items are met through the bodies' velocities, else null
};

/// What a sweep and a measure need of a law, always of a span of items.
template <class T>
struct SweepTable {
  int rows;
  void (*linearize)(const Pool<T>&, const WorldView<T>&, Rows<T>&);
  void (*prepare)(Pool<T>&, const Span<T>&, double h);  ///< what the law keeps of W_ii
  T (*sweep)(Pool<T>&, const Span<T>&, T relaxation);   ///< Σ w |Δλ|²
  void (*measure)(Pool<T>&, const Span<T>&, const T* d, MeasureSums&);
  void (*clamp)(Pool<T>&, const Span<T>&);                            ///< each λ into its cone
  void (*natural_map)(Pool<T>&, const Span<T>&, const T* u, T* out);  ///< w λ − P_K(w λ − ũ)
};

/// What Newton's method needs besides; only a solver that calls it has it compiled. With W replaced by w 1: λ
/// becomes what meets the law, and `slope` −∂λ/∂u. `before`, if there: a velocity whose slip is taken as
/// given, which makes the law convex.
template <class T>
struct NewtonTable {
  void (*tangent)(Pool<T>&, const Span<T>&, const T* u, T* lambda, T* slope);
  void (*convex_tangent)(Pool<T>&, const Span<T>&, const T* u, const T* before, T* lambda, T* slope);
};

template <class T>
struct Pool {
  const SweepTable<T>* sweeping;
  const NewtonTable<T>* newton = nullptr;  ///< set by a solver that differentiates
  Index items = 0, first_item = 0, first_row = 0;

  explicit Pool(const SweepTable<T>& table) : sweeping(&table) {}
  Pool(const Pool&) = delete;
  Pool& operator=(const Pool&) = delete;
};

/// H and φ of all items, pool by pool.
template <class T>
void linearize(std::span<Pool<T>* const> pools, const WorldView<T>& world, Rows<T>& rows) {
  rows.reset();
  for (Pool<T>* pool : pools) {
    pool->first_item = rows.items();
    pool->first_row = rows.count();
    pool->sweeping->linearize(*pool, world, rows);
  }
}

}  // namespace light
