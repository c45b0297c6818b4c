/// Nesterov's momentum over exact Gauss-Seidel sweeps, restarted when it turns against the residual.
#pragma once

#include <delassus/core/expect.hpp>
#include <delassus/core/roles.hpp>
#include <delassus/solvers/criteria.hpp>
#include <delassus/solvers/island_problem.hpp>
#include <delassus/solvers/solve_report.hpp>

#include <cmath>
#include <limits>
#include <utility>

namespace delassus {

/// With z = sweep(y):
///
///   x⁺ = z,  θ⁺ = (1 + √(1 + 4 θ²))/2,  y⁺ = P_K(x⁺ + (θ − 1)/θ⁺ (x⁺ − x)),
///
/// restarted (θ = 1, y = z) when (y − z)·(z − x) > 0 or when the sweep moved more than the one before. The best measured
/// iterate is kept. Source: [Nesterov1983] for the sequence, [ODonoghueCandes2015] for the gradient restart.
template <class Criterion = Residual>
struct BasicAcceleratedGaussSeidel {
  using plays = role::Solver;
  double tolerance = 1e-6;       ///< of the criterion
  int max_iterations = 4000;     ///< sweeps; reaching it is a status
  int min_iterations = 1;        ///< sweeps even when the warm start is within the tolerance
  double relaxation = 1;         ///< ω in (0, 2) of each sweep
  bool scale_tolerance = false;  ///< tolerance × number of rows
  bool all_verified = false;     ///< every constraint's share below the tolerance, not the sum

  template <class Rows>
  struct Workspace {
    Impulses<Rows> x, y, best;
    void reset(const Rows& rows) {
      for (auto* set : {&x, &y, &best}) set->resize_like(rows);
    }
  };

  void check() const {
    DELASSUS_EXPECT(tolerance >= 0, "AcceleratedGaussSeidel: tolerance " + inner::text(tolerance) + " must be >= 0");
    DELASSUS_EXPECT(max_iterations >= 0,
                    "AcceleratedGaussSeidel: max_iterations " + inner::text(max_iterations) + " must be >= 0");
    DELASSUS_EXPECT(relaxation > 0 && relaxation < 2,
                    "AcceleratedGaussSeidel: relaxation " + inner::text(relaxation) + " must lie in (0, 2)");
  }

  template <class Problem, class Workspace>
  SolveReport solve(Problem& problem, Workspace& work) const {
    const int rows = problem.row_count();
    SolveReport report;
    report.measure = problem.measure();
    problem.tell(0, report.measure);
    if (!std::isfinite(report.measure.residual)) return {.status = Status::quarantined, .measure = report.measure};
    if (min_iterations == 0 && is_done(report.measure, rows)) return finish(report, rows);

    problem.save(work.x);
    problem.save(work.best);
    Measure best = report.measure;
    double theta = 1, last = std::numeric_limits<double>::infinity();
    int measured = 0;
    for (bool is_last = max_iterations == 0; !is_last;) {
      problem.save(work.y);
      const double moved = problem.sweep(relaxation);  // λ is z now
      ++report.sweeps;
      is_last = report.sweeps == max_iterations || (report.sweeps >= min_iterations && problem.is_out_of_time());
      const int batch = Problem::Observes::every_sweep || !Criterion::needs_measure ? 1 : inner::patience(report.sweeps);
      if (report.sweeps - measured >= batch || is_last) {
        measured = report.sweeps;
        report.measure = problem.measure();
        problem.tell(report.sweeps, report.measure);
        if (report.sweeps >= min_iterations && is_done(report.measure, rows)) return finish(report, rows);
        if (report.measure.residual < best.residual) {
          best = report.measure;
          problem.save(work.best);
        }
      }
      if (!is_last) momentum(problem, work, theta, last, moved);
    }
    problem.load(work.best);
    report.measure = best;
    return finish(report, rows);
  }

 private:
  template <class Problem, class Workspace>
  static void momentum(Problem& problem, Workspace& work, double& theta, double& last, double moved) {
    const bool is_against = problem.curvature(work.y, work.x) > 0 || moved > last;
    // work.y has served; it takes z, the next x, while λ moves on to the next y.
    problem.save(work.y);
    if (is_against) {
      theta = 1;
      last = std::numeric_limits<double>::infinity();
    } else {
      const double next = 0.5 * (1 + std::sqrt(1 + 4 * theta * theta));
      problem.extrapolate(work.x, (theta - 1) / next);
      theta = next;
      last = moved;
    }
    std::swap(work.x, work.y);
  }

  bool is_done(const Measure& m, int rows) const {
    return inner::is_within<Criterion>(*this, m, rows) || m.residual <= m.floor;
  }
  SolveReport finish(SolveReport report, int rows) const {
    report.status = inner::verdict<Criterion>(*this, report.measure, rows);
    return report;
  }
};

using AcceleratedGaussSeidel = BasicAcceleratedGaussSeidel<>;

}  // namespace delassus
