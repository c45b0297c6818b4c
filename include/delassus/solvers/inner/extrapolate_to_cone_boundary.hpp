/// One step as long as a million sweeps, where λ drifts along impulses that move nothing.
#pragma once

#include <delassus/core/array.hpp>
#include <delassus/core/cmath.hpp>
#include <delassus/solvers/island.hpp>

namespace delassus::inner {

/// Sweeps of which λ's way is taken.
inline constexpr int drift_sweeps = 16;

/// √Σ w_k z_k² of a way z, zero where it was not straight or the pace not even, and √Σ w_k λ_k² at its
/// end.
struct SlowDirection {
  double length, size;
};

/// Plain sweeps, `before` being λ before them, z = λ − `before`.
template <class T>
[[gnu::noinline]] SlowDirection find_slow_direction(Island<T>& island, Array<T>& before) {
  island.save(before);
  double moved = 0, square = 0, size = 0;
  for (int k = 0; k < drift_sweeps; ++k) moved = island.sweep();
  const T* at = before.data();
  for (const Span<T>& span : island)
    for (const Index i : span) {
      const T* lambda = island.impulse(span, i);
      T way[most_rows];
      for (int k = 0; k < span.pool->rows; ++k) way[k] = lambda[k] - *at++;
      square += island.energy(span, i, way);
      size += island.energy(span, i, lambda);
    }
  const double length = std::sqrt(square), even = drift_sweeps * std::sqrt(moved);
  return {std::abs(length - even) < 0.02 * even ? length : 0, std::sqrt(size)};
}

/// The largest β < `most` with λ + β z in the cones of all laws but for a small share of β |z|, which is how
/// near an impulse that slides follows its cone; zero where no law ends the way, or one ends it here.
/// `length` is √Σ w_k z_k².
template <class T>
double reach(const Island<T>& island, const Array<T>& before, double length, double most) {
  constexpr double share = 1e-4;
  double beta = most;
  const T* at = before.data();
  for (const Span<T>& span : island) {
    const int R = span.pool->rows;
    for (const Index i : span) {
      const T *lambda = island.impulse(span, i), *start = at;
      at += R;
      if (!span.pool->table->clamp) continue;
      const auto is_outside = [&](double t) {
        T there[most_rows], inside[most_rows];
        for (int k = 0; k < R; ++k) there[k] = inside[k] = lambda[k] + T(t) * (lambda[k] - start[k]);
        island.clamp(span, i, inside);
        for (int k = 0; k < R; ++k) there[k] -= inside[k];
        return !(std::sqrt(island.energy(span, i, there)) <= share * t * length);
      };
      if (!(beta > 1) || !is_outside(beta)) continue;
      double low = 1, high = beta;
      if (is_outside(low)) low = high = 0;
      while (high > (1 + share) * low) {
        const double middle = std::sqrt(low * high);
        (is_outside(middle) ? high : low) = middle;
      }
      beta = low;
    }
  }
  return beta < most ? beta : 0;
}

/// Two contacts of one body can push against each other along the line between them and move nothing: W z =
/// 0. Where zᵀd ≠ 0 they cannot both stick, since zᵀu = zᵀd whatever λ is: one of them slips at that
/// velocity, its impulse at the edge of its cone. A capsule on a plane whose two gaps g differ by 3 µm asks
/// for some (g₁ − g₂)²/L h = 2e-9 m/s. A sweep takes λ by zᵀd/w along z, so that the edge is 1e8 sweeps away,
/// or 2e4 with momentum; Newton's method goes by zᵀd/(ε w) a factorization, and the ε that takes it there
/// leaves half of the digits. But the way is straight, and a cone ends it:
///
///   λ ← λ + β z,   β the largest with all impulses in their cones.
///
/// An impulse that begins to slip so is no larger than those that carry: a way of more than twice the length
/// of λ is none of these, but one of rows that contradict each other, and λ runs away along it. To be called
/// where sweeps have stalled, after `find_slow_direction`, which gives `way`. True where λ has gone so, and settled: from
/// there momentum goes on. What that would reach by itself within `patience` sweeps, which is patience²/4
/// plain ones, is left to it.
template <class T>
[[gnu::noinline]] bool extrapolate_to_cone_boundary(Island<T>& problem, auto& monitor, Array<T>& before, SlowDirection way, int patience) {
  constexpr int settling = 40, in_a_row = 8;
  double far = 0.25 * patience * patience / drift_sweeps;
  bool has_leapt = false;
  for (int k = 0; k < in_a_row && way.length > 0; ++k) {
    const double beta = reach(problem, before, way.length, 2 * way.size / way.length);
    if (!(beta > far)) break;
    if (!has_leapt) monitor.open("extrapolation", in_a_row * settling);
    has_leapt = true;
    far = 1;  // the rest of the way
    problem.extrapolate(before, beta);
    for (int n = 0; n < settling; ++n)
      if (!monitor.goes_on(problem.sweep())) return true;
    way = find_slow_direction(problem, before);
  }
  return has_leapt;
}

}  // namespace delassus::inner
