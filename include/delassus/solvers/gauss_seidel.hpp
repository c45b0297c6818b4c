/// Gauss-Seidel sweeps over all constraints of an island, one local law at a time.
#pragma once

#include <delassus/core/cmath.hpp>
#include <delassus/core/expect.hpp>
#include <delassus/core/roles.hpp>
#include <delassus/solvers/island.hpp>
#include <delassus/solvers/solve_options.hpp>
#include <delassus/solvers/solve_report.hpp>

namespace delassus {

/// λ_i ← law_i(W_ii, d_i + Σ_j W_ij λ_j) for i = 1 … n, until the criterion holds. Contracts like r/(1 + r) for a heavy
/// body on a light one of mass ratio r and like cos²(π/2N) for N bodies on each other: `AcceleratedGaussSeidel` is the
/// default for that reason.
struct GaussSeidel {
  using plays = role::Solver;
  double tolerance = 1e-6;       ///< of the criterion
  int max_iterations = 1000;     ///< sweeps; reaching it is a status
  int min_iterations = 1;        ///< sweeps even when the warm start is within the tolerance
  double relaxation = 1;         ///< ω in (0, 2), inside the projection: the result stays in the cone
  bool scale_tolerance = false;  ///< tolerance × number of rows
  bool all_verified = false;     ///< every constraint's share below the tolerance, not the sum
  Criterion criterion = Criterion::residual;  ///< what the tolerance is compared with

  static constexpr Needs needs = Needs::sweeps;
  template <class Rows>
  struct Workspace {};

  SolveOptions options() const { return {tolerance, max_iterations, min_iterations, scale_tolerance, all_verified, criterion}; }
  void check() const {
    inner::expect_at_least_zero("GaussSeidel: tolerance", tolerance);
    inner::expect_at_least_zero("GaussSeidel: max_iterations", max_iterations);
    inner::expect_number(relaxation > 0 && relaxation < 2, "GaussSeidel: relaxation", relaxation,
                         "must lie in (0, 2)");
  }

  template <class T, class Room>
  SolveReport solve(Island<T>& problem, Room&) const {
    const int rows = problem.row_count();
    const SolveOptions limits = options();
    const bool is_measured = limits.is_measured();
    SolveReport report;
    report.measure = problem.measure();
    problem.notify(0, report.measure);
    if (!std::isfinite(report.measure.residual)) return {.status = Status::quarantined, .measure = report.measure};
    bool is_over = max_iterations == 0;
    while (!is_over) {
      const bool is_done = is_measured ? limits.is_done(report.measure, rows) : limits.is_within(report.measure, rows);
      if (report.sweeps >= min_iterations && is_done) break;
      const int batch = is_measured && !problem.observes_sweeps() ? inner::patience(report.sweeps) : 1;
      for (int k = 0; k < batch && !is_over && !(k > 0 && problem.is_measure_due()); ++k) {
        problem.sweep({.relaxation = relaxation, .tells_change = !is_measured});
        ++report.sweeps;
        is_over = report.sweeps == max_iterations || (report.sweeps >= min_iterations && problem.is_out_of_time());
      }
      report.measure.last_change = problem.last_change(), report.measure.worst_change = problem.worst_change();
      report.measure.sinking = 0;
      // Changes are compared first: a measure costs a sweep.
      if (is_measured || problem.observes_sweeps() || is_over || limits.is_within(report.measure, rows)) report.measure = problem.measure();
      problem.notify(report.sweeps, report.measure);
    }
    report.status = limits.verdict(report.measure, rows);
    return report;
  }
};

}  // namespace delassus
