/// Nesterov's momentum over any sweep, restarted when it turns against the residual.
#pragma once

#include <cmath>
#include <limits>

namespace delassus::inner {

/// With z = sweep(y), y = P_K(x + (θ₋ − 1)/θ (x − x₋)):
///
///   x⁺ = z,  θ⁺ = (1 + √(1 + 4 θ²))/2,
///
/// restarted (θ = 1, y = z) when (y − z)·(z − x) > 0 or when the sweep moved more than `slack` times the one
/// before, in energy. No slack converges where rows are soft, and is slow on rigid ones; a slack of 4 the
/// other way round. It begins without, and changes over after 60 sweeps none of which halved the movement.
/// `x` is room for the impulses before; sweep(x, curvature) sets that product and returns how much it moved.
/// Source: [Nesterov1983] for the sequence, [ODonoghueCandes2015] for the gradient restart.
template <class Problem, class Pursuit, class Impulses, class Sweep>
void momentum(Problem& problem, Pursuit& pursuit, Impulses& x, Sweep&& sweep) {
  constexpr double infinity = std::numeric_limits<double>::infinity();
  double theta = 1, last = infinity, slack = 1, least = infinity;
  int unhalved = 0;
  problem.save(x);
  for (;;) {
    double curvature = 0;
    const double moved = sweep(x, curvature);  // λ is z now
    if (!pursuit.goes_on(moved)) return;
    if (moved < 0.25 * least) {
      least = moved;
      unhalved = 0;
    } else if (++unhalved > 60) {
      slack = 5 - slack;
      least = moved;
      unhalved = 0;
    }
    if (curvature > 0 || moved > slack * last) {
      problem.save(x);
      theta = 1;
      last = infinity;
    } else {
      const double next = 0.5 * (1 + std::sqrt(1 + 4 * theta * theta));
      if (theta > 1)
        problem.extrapolate(x, (theta - 1) / next);
      else
        problem.save(x);
      theta = next;
      last = moved;
    }
  }
}

}  // namespace delassus::inner
