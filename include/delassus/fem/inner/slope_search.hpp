/// How far to go along a step of Newton's method, by the slope alone.
#pragma once

#include <delassus/core/cmath.hpp>
#include <delassus/core/index.hpp>
#include <delassus/math/twist.hpp>

#include <limits>

namespace delassus::inner {

/// The share s ∈ {first, first/2, …} of a step δ after which the residual r(s) does not push back by more
/// than half of what drove the step: r(s)·δ ≥ −½ r(0)·δ. `slope_at(s)` is r(s)·δ. With A positive r(0)·δ > 0,
/// so a short step is always taken. Needs no energy, so that moments, which have none, may act. Source:
/// docs/references.md, [MatthiesStrang1979].
template <class Slope>
double slope_search(double first, double start, Slope&& slope_at) {
  double s = first;
  for (int halvings = 0; halvings < 12; ++halvings, s /= 2) {
    const double slope = slope_at(s);
    if (slope >= -0.5 * std::abs(start)) return s;
  }
  return s;
}

/// Σ f·x over the blocks that move.
template <class Set, class Vectors>
double work_along(const Set& set, const Vectors& f, const Vectors& x) {
  double sum = 0;
  for (const Index b : set.active())
    if (set.moves(b)) sum += double(f[b].dot(x[b]));
  return sum;
}

/// The share of a step that turns no node by more than a radian: further on K says nothing of what comes.
template <class Set, class Vectors>
double share_within_a_radian(const Set& set, const Vectors& step) {
  double most = 0;
  if constexpr (Set::width == 6)
    for (const Index b : set.active())
      if (set.moves(b)) most = std::fmax(most, double(angular_part(step[b]).norm()));
  return most > 1 ? 1 / most : 1;
}

/// The largest entry in size of the blocks that move; no number where one of them is none.
template <class Set, class Vectors>
double largest(const Set& set, const Vectors& x) {
  double most = 0;
  for (const Index b : set.active()) {
    if (!set.moves(b)) continue;
    if (!is_finite(x[b])) return std::numeric_limits<double>::quiet_NaN();
    for (int i = 0; i < Set::width; ++i) most = std::fmax(most, std::abs(double(x[b][i])));
  }
  return most;
}

}  // namespace delassus::inner
