/// Nesterov's momentum over any sweep, restarted when it turns against the residual.
#pragma once

#include <cmath>
#include <limits>
#include <utility>

namespace delassus::inner {

/// With z = sweep(y), y = P_K(x + (θ₋ − 1)/θ (x − x₋)):
///
///   x⁺ = z,  θ⁺ = (1 + √(1 + 4 θ²))/2,
///
/// restarted (θ = 1, y = z) when (y − z)·(z − x) > 0 or when the sweep moved more than the one before. `x` and `y` are room
/// for two sets of impulses. Source: [Nesterov1983] for the sequence, [ODonoghueCandes2015] for the gradient restart.
template <class Problem, class Pursuit, class Impulses, class Sweep>
void momentum(Problem& problem, Pursuit& pursuit, Impulses& x, Impulses& y, Sweep&& sweep) {
  double theta = 1, last = std::numeric_limits<double>::infinity();
  problem.save(x);
  for (;;) {
    problem.save(y);
    const double moved = sweep();  // λ is z now
    if (!pursuit.goes_on()) return;
    const bool is_against = problem.curvature(y, x) > 0 || moved > last;
    problem.save(y);  // y has served; it takes z, the next x, while λ moves on to the next y
    if (is_against) {
      theta = 1;
      last = std::numeric_limits<double>::infinity();
    } else {
      const double next = 0.5 * (1 + std::sqrt(1 + 4 * theta * theta));
      problem.extrapolate(x, (theta - 1) / next);
      theta = next;
      last = moved;
    }
    std::swap(x, y);
  }
}

}  // namespace delassus::inner
