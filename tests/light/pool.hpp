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

/// f(width), a constant for bodies and particles.
template <class F>
[[gnu::always_inline]] inline void with_width(int width, const F& f) {
  if (width == 6)
    f(std::integral_constant<int, 6>{});
  else if (width == 3)
    f(std::integral_constant<int, 3>{});
  else
    f(width);
}

/// u += H y.
template <int R, class T>
[[gnu::always_inline]] inline void add_product(const T* H, const T* y, int width, T* u) {
  T sum[R];
  for (int k = 0; k < R; ++k) sum[k] = H[k] * y[0];
  for (int j = 1; j < width; ++j)
    for (int k = 0; k < R; ++k) sum[k] += H[k + R * j] * y[j];
  for (int k = 0; k < R; ++k) u[k] += sum[k];
}

/// to += H G, with `line` numbers from one column of G to the next.
template <int R, class T>
void add_block(const T* H, const T* G, int width, Index line, int columns, T* to) {
  with_width(width, [&](auto w) {
    for (int c = 0; c < columns; ++c, G += line, to += R) add_product<R>(H, G, w, to);
  });
}

/// A block of W whose columns are an item of another pool.
struct OtherBlock {
  Index row;  ///< the first of the columns, in the flat λ
  int width;
  Index place;
};

/// What a pool reads of all others: its items' blocks, and the flat λ.
template <class T>
struct OtherBlocks {
  const Index* start;
  const OtherBlock* list;
  const T *block, *lambda;
};

/// base = d + Σ W_ij λ_j over the items j of all other pools: once a span, R a constant and the width of a
/// block a number, so that R kernels are compiled and not R².
template <int R, class T>
void sum_others(const Span<T>& span, const T* d, const OtherBlocks<T>& from, T* base) {
  for (Index n = 0; n < span.count; ++n) {
    const Index i = span.items[n];
    T u[R];
    for (int k = 0; k < R; ++k) u[k] = d[std::size_t(R) * i + k];
    for (Index e = from.start[i]; e < from.start[i + 1]; ++e) {
      const auto [row, width, place] = from.list[e];
      const T *w = from.block + place, *x = from.lambda + row;
      if (width == R)  // most of them
        for (int c = 0; c < R; ++c)
          for (int k = 0; k < R; ++k) u[k] += w[k + R * c] * x[c];
      else
        for (const T* const end = x + width; x != end; ++x, w += R)
          for (int k = 0; k < R; ++k) u[k] += w[k] * *x;
    }
    for (int k = 0; k < R; ++k) base[std::size_t(R) * i + k] = u[k];
  }
}

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
  // Of the number of rows alone.
  void (*sum_others)(const Span<T>&, const T* d, const OtherBlocks<T>&, T* base);
  void (*add_block)(const T* H, const T* G, int width, Index line, int columns, T* to);
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
