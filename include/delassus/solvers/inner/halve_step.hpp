/// How far to go along a direction of Newton's method.
#pragma once

#include <limits>

namespace delassus::inner {

/// Halves a step until the size of F has fallen by a thousandth of it, else takes the best of `most` tries; leaves F
/// evaluated there. evaluate(t) gives the size of F after the share t of the step; `size` is that at its start, and then
/// that where it ends. Returns the share.
double halve_step(double& size, int most, const auto& evaluate) {
  double best = 0, least = std::numeric_limits<double>::infinity(), fraction = 1;
  for (int halving = 0; halving < most; ++halving, fraction *= 0.5) {
    const double trial = evaluate(fraction);
    if (trial <= (1 - 1e-3 * fraction) * size) {
      size = trial;
      return fraction;
    }
    if (trial < least) least = trial, best = fraction;
  }
  size = evaluate(best);
  return best;
}

}  // namespace delassus::inner
