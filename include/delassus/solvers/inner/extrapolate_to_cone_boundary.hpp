/// One step as long as a million sweeps, where λ drifts along impulses that move nothing.
#pragma once

#include <delassus/core/index.hpp>
#include <delassus/math/linear.hpp>
#include <delassus/rows/impulses.hpp>

#include <cmath>
#include <tuple>

namespace delassus::inner {

/// Sweeps of which λ's way is taken.
inline constexpr int drift_sweeps = 16;

/// √Σ w_i |z_i|² of a way z, zero where it was not straight or the pace not even, and √Σ w_i |λ_i|² at its
/// end.
struct SlowDirection {
  double length, size;
};

/// Plain sweeps, `before` being λ before them, z = λ − `before`.
[[gnu::noinline]] SlowDirection find_slow_direction(auto& problem, auto& before) {
  problem.save(before);
  double moved = 0, square = 0, size = 0;
  for (int k = 0; k < drift_sweeps; ++k) moved = problem.sweep();
  problem.each([&](auto p, Index i) {
    const double root = problem.template root_of_weight<p>(i);
    const auto& lambda = problem.rows().template pool<p>().lambda[i];
    const auto z = lambda - std::get<p>(before.pools)[i];
    square += root * root * double(z.squaredNorm());
    size += root * root * double(lambda.squaredNorm());
  });
  const double length = std::sqrt(square), even = drift_sweeps * std::sqrt(moved);
  return {std::abs(length - even) < 0.02 * even ? length : 0, std::sqrt(size)};
}

/// The largest β < `most` with λ + β z in the cones of all laws but for a small share of β |z|, which is how
/// near an impulse that slides follows its cone; zero where no law ends the way, or one ends it here.
/// `length` is √Σ w_i |z_i|².
template <class Problem, class Impulses>
double reach(const Problem& problem, const Impulses& before, double length, double most) {
  using T = typename Problem::T;
  constexpr double share = 1e-4;
  double beta = most;
  problem.each([&](auto p, Index i) {
    if constexpr (Problem::BookType::template clamps<p>()) {
      const auto lambda = problem.rows().template pool<p>().lambda[i];
      const auto z = (lambda - std::get<p>(before.pools)[i]).eval();
      const double root = problem.template root_of_weight<p>(i);
      const auto is_outside = [&](double t) {
        const auto there = (lambda + T(t) * z).eval();
        auto inside = there;
        problem.book().template clamp<p>(i, inside);
        return !(root * double((there - inside).norm()) <= share * t * length);
      };
      if (!(beta > 1) || !is_outside(beta)) return;
      double low = 1, high = beta;
      if (is_outside(low)) low = high = 0;
      while (high > (1 + share) * low) {
        const double middle = std::sqrt(low * high);
        (is_outside(middle) ? high : low) = middle;
      }
      beta = low;
    }
  });
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
[[gnu::noinline]] bool extrapolate_to_cone_boundary(auto& problem, auto& monitor, auto& before, SlowDirection way, int patience) {
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
