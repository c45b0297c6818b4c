/// Impulses for rows that contradict each other.
#pragma once

#include <delassus/solvers/solve_options.hpp>
#include <delassus/solvers/inner/convergence_monitor.hpp>
#include <delassus/solvers/inner/momentum.hpp>
#include <delassus/solvers/inner/softened.hpp>
#include <delassus/solvers/solve_report.hpp>

namespace delassus::inner {

/// λ of the rows as `Softened` lets them yield, from zero, and the errors of the rows as they are. The report
/// is that of what found the contradiction.
template <class T>
SolveReport compromise(Island<T>& problem, SolveReport report, Array<T>& best, Array<T>& last) {
  problem.must_complete();
  Softened<T> softened(problem);
  Island<T>& soft = softened.island();
  const SolveOptions limits{.max_iterations = 1000, .min_iterations = 1};
  ConvergenceMonitor<Island<T>, Array<T>> monitor(limits, soft, best);
  if (monitor.begin()) {
    monitor.open("compromise", limits.max_iterations);
    NoNewton no_newton;
    momentum(soft, monitor, last, SweepRule{}, no_newton, "compromise");
  }
  report.sweeps += monitor.finish().sweeps;
  softened.restore();
  report.measure = problem.measure();
  report.status = Status::infeasible;
  report.ended_by = "compromise";
  return report;
}

}  // namespace delassus::inner
