/// Nesterov's momentum over any sweep, restarted when it turns against the residual.
#pragma once

#include <delassus/core/array.hpp>
#include <delassus/core/cmath.hpp>
#include <delassus/solvers/inner/pile_sweeps.hpp>
#include <delassus/solvers/island.hpp>

#include <algorithm>
#include <limits>

namespace delassus::inner {

/// When momentum has gone on for too long. The gradient restart, (y − z)·(z − x) > 0, is enough where rows
/// are rigid; where they yield, momentum over sweeps can grow between two such restarts and go round for
/// ever. A sweep that moved four times the energy of the least since the last restart therefore asks for one
/// too, and makes the rule strict: from then on no sweep may move more than the one before. Strictness costs
/// rigid rows sweeps, so that it ends with 60 that did not halve the movement.
class RestartRule {
 public:
  /// After a sweep that moved λ by `moved` in energy, its product being `curvature`.
  bool asks(double curvature, double moved) {
    const bool has_grown = moved > (is_strict_ ? last_ : 4 * least_since_restart_);
    const bool is_asked = curvature > 0 || has_grown;
    ++since_change_;
    is_futile_ = false;
    if (moved < 0.25 * least_) {
      least_ = moved;
      unhalved_ = 0;
    } else if (is_strict_ ? ++unhalved_ > 60 : has_grown && curvature <= 0) {
      is_futile_ = is_strict_ && was_short_;
      was_short_ = !is_strict_ && since_change_ <= 12;
      is_strict_ = !is_strict_;
      least_ = moved;
      unhalved_ = since_change_ = 0;
    }
    last_ = is_asked ? infinity : moved;
    least_since_restart_ = is_asked ? infinity : std::min(least_since_restart_, moved);
    return is_asked;
  }
  /// That sweep was the last of a strict time that did not halve the movement, and the loose time before it
  /// ended in growth at once: the mark of going round in circles.
  bool is_futile() const { return is_futile_; }

 private:
  static constexpr double infinity = std::numeric_limits<double>::infinity();
  double last_ = infinity, least_since_restart_ = infinity, least_ = infinity;
  int unhalved_ = 0, since_change_ = 0;
  bool is_strict_ = false, was_short_ = false, is_futile_ = false;
};

/// Sweeps alone.
struct NoNewton {
  static constexpr bool opens() { return false; }
  static void run() {}
};

/// With z = sweep(y), y = P_K(x + (θ₋ − 1)/θ (x − x₋)):
///
///   x⁺ = z,  θ⁺ = (1 + √(1 + 4 θ²))/2,
///
/// and where `RestartRule` asks for it y = z once and θ⁺ = θ/2: a restart from θ = 1 would forget how slow
/// the problem is, and take up to twice the sweeps on rigid rows. Ends, and returns true, where the restarts are
/// futile and the error stands. A pile has rules of its own, `PileSweeps`. Where `newton` opens it acts, and momentum
/// begins anew. `x` is room for the impulses before; the monitor calls the stage `name`. Source: [Nesterov1983] for the sequence, [ODonoghueCandes2015] for the
/// gradient restart.
template <class T, class ConvergenceMonitor, class Newton>
bool momentum(Island<T>& problem, ConvergenceMonitor& monitor, Array<T>& x, const SweepRule& rule, Newton& newton, const char* name) {
  PileSweeps pile(rule);
  for (;;) {
    RestartRule restarts;
    double theta = 1;
    bool is_first = true, is_futile = false;
    while (!is_futile && !newton.opens()) {
      double curvature = 0;  // of the first sweep, where y = x, it is −(z − x)²: no sign of a restart
      const double moved = problem.sweep(pile.rule(), is_first ? nullptr : x.data(), is_first ? nullptr : &curvature);  // λ is z now
      is_first = false;
      if (!monitor.goes_on(moved)) break;
      if (pile.turns(problem, monitor)) {
        problem.save(x);
        theta = 1;
        is_first = true;
        continue;
      }
      if (pile.is_on() ? pile.asks(curvature, moved) : restarts.asks(curvature, moved)) {
        problem.save(x);
        theta = std::max(1.0, 0.5 * theta);
        is_futile = restarts.is_futile() && monitor.is_stagnating();
      } else {
        const double next = 0.5 * (1 + std::sqrt(1 + 4 * theta * theta));
        if (theta > 1) problem.extrapolate(x, (theta - 1) / next);
        else problem.save(x);
        theta = next;
      }
    }
    if (monitor.is_over() || !newton.opens()) return is_futile;
    newton.run();
    if (monitor.is_over()) return false;
    monitor.name(name);
  }
}

}  // namespace delassus::inner
