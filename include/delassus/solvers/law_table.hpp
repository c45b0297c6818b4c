/// The laws of a pool as a solver meets them: a table of loops over spans of items.
#pragma once

#include <delassus/core/index.hpp>
#include <delassus/rows/row_kind.hpp>
#include <delassus/rows/row_view.hpp>
#include <delassus/solvers/measure.hpp>

namespace delassus {

/// What a solver asks of laws beside sweeps: a solver says `static constexpr Needs needs`. What nobody needs is not compiled.
enum class Needs { sweeps, tangents, convex_tangents };

namespace inner {

template <class Solver>
inline constexpr Needs needs_of = Needs::tangents;
template <class Solver>
  requires requires { Solver::needs; }
inline constexpr Needs needs_of<Solver> = Solver::needs;

}  // namespace inner

template <class T>
struct LawTable;
template <class T>
struct PoolView;

/// λ and −∂λ/∂d (R × R, by columns) of item i's law where W is diag(w) and its velocity is d around λ; see `Differentiable`.
template <class T>
using Tangent = void (*)(const PoolView<T>&, Index i, const double* w, const double* d, double* lambda, double* slope);
/// The same with the slip of friction rows given; see `ConvexContact`.
template <class T>
using ConvexTangent = void (*)(const PoolView<T>&, Index i, const double* w, const double* d, double slip, double* lambda,
                               double* slope);

/// A pool of rows under its law.
template <class T>
struct PoolView : RowView<T> {
  const LawTable<T>* table = nullptr;
  Tangent<T> tangent = nullptr;  ///< null where the law has none, or nobody asked for it
  ConvexTangent<T> convex_tangent = nullptr;
  const void *law = nullptr, *law_items = nullptr;
  const Index* places = nullptr;  ///< of item i among `law_items`; null: i itself
  void* memory = nullptr;         ///< what the law keeps of each item
};

/// Some items of a pool: ascending, or in an order by which the last is not `count` − 1 behind the first.
template <class T>
struct Span {
  const PoolView<T>* pool;
  const Index* items;
  Index count;

  /// Its items follow each other. Pre: there is one.
  bool is_gapless() const { return items[count - 1] - items[0] == count - 1; }
  const Index* begin() const { return items; }
  const Index* end() const { return items + count; }
};

/// How a sweep is made, and sums over the items it visits: Σ w |Δλ|², Σ w Δλ·(λ − x), Σ |w Δλ| and the largest |w Δλ|, m/s.
template <class T>
struct Sweep {
  T relaxation = 1;
  const T* x = nullptr;  ///< λ of the span's items one after the other, from before; null: `along` is nobody's
  bool tells_change = false;
  double length = 1;  ///< see `Measure`, m: for rows that turn
  double energy = 0, along = 0, displacement = 0, most = 0;
};

/// What a law does, over a span of items each: one constant table a law and scalar.
template <class T>
struct LawTable {
  const RowKind* kinds;  ///< `rows` of them
  /// What the law keeps of W_ii, of all items where a span has no list of them.
  void (*prepare)(const Span<T>&, double h);
  /// Leaves each item with an impulse that meets its law while the others stand still.
  void (*sweep)(const Span<T>&, Sweep<T>&);
  /// λ_i ← P_K(λ_i − ũ_i/s), s = |W_ii|.
  void (*project_once)(const Span<T>&, Sweep<T>&);
  void (*measure)(const Span<T>&, MeasureSums&);
  /// λ ← λ + β (λ − before), brought back into the law's cone; `before` takes the λ that was.
  void (*extrapolate)(const Span<T>&, T* before, T beta);
  /// λ_i ← the nearest in the law's cone; null where any impulse will do.
  void (*clamp)(const PoolView<T>&, Index i, T* lambda);
  /// W hears that λ_i was changed by δ.
  void (*changed)(const PoolView<T>&, Index i, const T* change);
  /// u_i = (d + W λ)_i.
  void (*velocity)(const PoolView<T>&, Index i, T* u);
  /// What an item with velocity u and impulse λ of its own adds to the measure.
  void (*add_share)(const PoolView<T>&, Index i, const T* u, const T* lambda, MeasureSums&);
  /// μ of a round cone; null where the law is none.
  double (*friction)(const PoolView<T>&, Index i);
  bool is_coulomb;  ///< `Coulomb` answers for each item from its own memory, whatever is around it
  /// λ_i ← (1 − ω) λ_i + ω P(λ_i − M⁻¹ ũ_i) in a metric M ≥ W_ii; null where the law has no such projection.
  void (*descend)(const Span<T>&, Sweep<T>&);
};

}  // namespace delassus
