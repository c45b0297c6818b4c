/// Impulses for rows that contradict each other.
#pragma once

#include <delassus/solvers/criteria.hpp>
#include <delassus/solvers/inner/convergence_monitor.hpp>
#include <delassus/solvers/inner/momentum.hpp>
#include <delassus/solvers/inner/softened.hpp>
#include <delassus/solvers/solve_report.hpp>

namespace delassus::inner {

/// λ of the rows as `Softened` lets them yield, from zero, and the errors of the rows as they are. The report
/// is that of what found the contradiction.
template <class Problem, class Impulses>
SolveReport compromise(Problem& problem, SolveReport report, Impulses& best, Impulses& last) {
  problem.must_complete();
  Softened<Problem> soft(problem);
  const SolveLimits limits{.max_iterations = 1000, .min_iterations = 1};
  ConvergenceMonitor<Residual, SolveLimits, Softened<Problem>, Impulses> monitor(limits, soft, best);
  if (monitor.begin()) {
    monitor.open("compromise", limits.max_iterations);
    momentum(soft, monitor, last, [&](auto& x, double& curvature) { return soft.sweep(1, x, curvature); });
  }
  report.sweeps += monitor.finish().sweeps;
  soft.restore();
  report.measure = problem.measure();
  report.status = Status::infeasible;
  report.ended_by = "compromise";
  return report;
}

}  // namespace delassus::inner
