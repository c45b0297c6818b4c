/// A proof that the rows of an island contradict each other.
#pragma once

#include <delassus/core/cmath.hpp>
#include <delassus/rows/row_kind.hpp>
#include <delassus/core/array.hpp>
#include <delassus/solvers/inner/alike_bodies.hpp>
#include <delassus/solvers/island.hpp>

#include <algorithm>
#include <limits>

namespace delassus::inner {

/// Impulses z that move nothing and yet would do work against what the rows ask: z free on an equality and in
/// a motor without a cap, ≥ 0 on a lower row, ≤ 0 on an upper one, 0 where friction or a bound holds, and
///
///   W z = 0,   dᵀz < 0.
///
/// Velocities u = d + W λ that meet the rows have zᵀu ≥ 0, but zᵀu = dᵀz < 0 whatever λ is: there are none.
/// In numbers W z is not zero, and what is proved is that λ would have to be large: with y = √w λ by row,
///
///   |y| ≥ −dᵀz/√(Σ (W z)²/w),
///
/// which must be `margin` times √(Σ d²/w), with W z known to no more than the rounding of d, since z is
/// scaled to be as large as d. A mass ratio r would need y of r times that and look like a contradiction, though masses are none:
/// which velocities d + W λ can be reached, H and d say. So W is that of `AlikeBodies`, and only levers and angles make y large.
/// Where W alone is known it is that, and the margin is beyond any ratio that sweeps get through. Joints that contradict each
/// other through a body that contacts hold are found without the contacts, which would let W z fall slowly. In single precision
/// there is no such margin: nothing is proved there. Source: [Gale1960], the theorem of the alternative.
template <class T>
class Contradiction {
  static constexpr double rounding = std::numeric_limits<double>::epsilon();
  static constexpr double margin = 1.5e10;
  struct Sums {
    double work = 0, moved = 0, free = 0, size = 0;
  };

 public:
  [[gnu::always_inline]] explicit Contradiction(const Island<T>& island) : whole_(island), island_(sizeof(T) == sizeof(double) && alike_.take(island) ? alike_.island(island) : island) {}
  [[gnu::always_inline]] ~Contradiction() {}

  /// From the direction in which λ has gone since `before` was saved; λ is something else afterwards.
  bool is_proved(const Array<T>& before) {
    if constexpr (sizeof(T) < sizeof(double)) return false;
    // z is scaled before W hears of it: λ that has run away would leave its rounding in velocities that are sums of changes.
    T z[most_rows];
    double size = 0, free = 0;
    for (const bool is_scaled : {false, true}) {
      const double factor = is_scaled ? std::sqrt(free / size) : 1;
      if (is_scaled && !(factor > 0 && std::isfinite(factor))) return false;
      const T* at = before.data();
      const Span<T>* from = whole_.begin();
      for (const Span<T>& span : island_) {
        for (const Index i : span) {
          const T *lambda = whole_.impulse(*from, i), *d = island_.free_of_impulses(span, i);
          for (int k = 0; k < span.pool->rows; ++k) z[k] = lambda[k] - *at++;
          clear_bounded(span, i, z);
          double w[most_rows];
          span.pool->weights(i, w);
          for (int k = 0; k < span.pool->rows; ++k) {
            if (!is_scaled && w[k] > 0) size += w[k] * double(z[k]) * double(z[k]), free += double(d[k]) * double(d[k]) / w[k];
            z[k] *= T(factor);
          }
          if (is_scaled) island_.assign(span, i, z);
        }
        ++from;
      }
    }
    if (moves_nothing()) return true;
    bool has_less = false;
    has_two_sided_alone_ = true;
    for (const Span<T>& span : island_)
      for (const Index i : span) {
        const T* whole = island_.impulse(span, i);
        for (int k = 0; k < span.pool->rows; ++k) z[k] = whole[k];
        clear_bounded(span, i, z);
        for (int k = 0; k < span.pool->rows; ++k) has_less = has_less || z[k] != whole[k];
        island_.assign(span, i, z);
      }
    return has_less && moves_nothing();
  }

 private:
  /// Sweeps take W z to zero; whether z still does work then.
  bool moves_nothing() {
    if (!scale_to_free()) return false;
    double last = std::numeric_limits<double>::infinity(), promise = 0;
    for (int round = 0; round < 40; ++round) {
      const Sums s = measure();
      const double free = std::sqrt(s.free), size = std::sqrt(s.size);
      const double moved = std::sqrt(s.moved) + 8 * rounding * free;
      if (s.work > 1e-6 * free * size && s.work >= margin * moved * free) return true;
      if (!(s.work > 1e-6 * free * size) || !(moved < 0.7 * last) || island_.is_out_of_time()) return false;
      // Where rows agree dᵀz goes to zero with W z, else it stays: then their ratio grows by 1/0.7 a round.
      if (round % 3 == 0) {
        if (s.work < 1.2 * promise * moved) return false;
        promise = s.work / moved;
      }
      last = moved;
      for (int k = 0; k < 8 && !island_.is_out_of_time(); ++k) sweep();
    }
    return false;
  }

  void clear_bounded(const Span<T>& span, Index i, T* z) const {
    for (int k = 0; k < span.pool->rows; ++k) z[k] = allowed(span, i, k, z[k]);
  }
  T allowed(const Span<T>& span, Index i, int row, T z) const {
    switch (island_.kinds(span)[row]) {
      case RowKind::equality:
        return z;
      case RowKind::lower:
        return has_two_sided_alone_ ? T(0) : std::max(z, T(0));
      case RowKind::upper:
        return has_two_sided_alone_ ? T(0) : std::min(z, T(0));
      case RowKind::friction:
        break;
    }
    return has_no_cap(span, i) ? z : T(0);
  }
  /// A row alone whose law leaves any impulse as it is.
  static bool has_no_cap(const Span<T>& span, Index i) {
    if (span.pool->rows != 1 || !span.pool->table->clamp) return false;
    const T most = std::sqrt(std::numeric_limits<T>::max());
    T huge = most;
    Island<T>::clamp(span, i, &huge);
    return huge == most;
  }

  /// z ← z |d|/|z|, both in energy: (d + W z) − d loses what is smaller than the rounding of d. False for
  /// z = 0.
  bool scale_to_free() {
    const Sums s = measure();
    const double factor = std::sqrt(s.free / s.size);
    if (!(factor > 0) || !std::isfinite(factor)) return false;
    T next[most_rows];
    for (const Span<T>& span : island_)
      for (const Index i : span) {
        const T* z = island_.impulse(span, i);
        for (int k = 0; k < span.pool->rows; ++k) next[k] = z[k] * T(factor);
        island_.assign(span, i, next);
      }
    return true;
  }

  Sums measure() const {
    Sums s;
    T u[most_rows];
    for (const Span<T>& span : island_)
      for (const Index i : span) {
        double w[most_rows];
        span.pool->weights(i, w);
        island_.velocity(span, i, u);
        const T *d = island_.free_of_impulses(span, i), *z = island_.impulse(span, i);
        for (int k = 0; k < span.pool->rows; ++k) {
          if (!(w[k] > 0)) continue;
          const double Wz = double(u[k] - d[k]), free = double(d[k]), along = double(z[k]);
          s.work -= free * along, s.moved += Wz * Wz / w[k], s.free += free * free / w[k], s.size += w[k] * along * along;
        }
      }
    return s;
  }

  /// Gauss-Seidel on min ½ zᵀ W z, row by row.
  void sweep() {
    T u[most_rows], z[most_rows];
    for (const Span<T>& span : island_)
      for (const Index i : span) {
        const int R = span.pool->rows;
        const T *d = island_.free_of_impulses(span, i), *now = island_.impulse(span, i), *own = span.pool->own_block(i);
        island_.velocity(span, i, u);
        for (int k = 0; k < R; ++k) u[k] -= d[k], z[k] = now[k];  // (W z)_i
        for (int k = 0; k < R; ++k) {
          const T* column = own + R * k;
          if (!(column[k] > T(0))) continue;
          const T next = allowed(span, i, k, z[k] - u[k] / column[k]), change = next - z[k];
          z[k] = next;
          for (int j = 0; j < R; ++j) u[j] += column[j] * change;
        }
        island_.assign(span, i, z);
      }
  }

  const Island<T>& whole_;
  AlikeBodies<T>& alike_ = AlikeBodies<T>::of_this_thread();
  Island<T> island_;
  bool has_two_sided_alone_ = false;  ///< z = 0 on lower and upper rows
};

/// Whether λ runs away because the rows contradict each other: asked where sweeps have stalled, a few after λ
/// was `before`. Costs little where λ does not, forty sweeps where the rows agree, and at most some three
/// hundred.
template <class T, class ConvergenceMonitor>
bool contradicts(Island<T>& island, ConvergenceMonitor& monitor, const Array<T>& before) {
  if (!island.is_cut_off(0) && Contradiction<T>(island).is_proved(before)) return true;
  monitor.back_to_best();
  return false;
}

}  // namespace delassus::inner
