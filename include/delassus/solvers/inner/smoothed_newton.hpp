/// Newton's method on contact laws without their corners: dense, from λ = 0, for islands of some hundred
/// contacts.
#pragma once

#include <delassus/core/status.hpp>
#include <delassus/solvers/inner/smoothed_laws.hpp>
#include <delassus/solvers/measure.hpp>
#include <delassus/solvers/solve_report.hpp>

#include <algorithm>
#include <cmath>

namespace delassus::inner {

/// Follows the solutions of `SmoothedRows` as τ goes to zero. Where points of contact are redundant and their
/// gaps do not fit, λ has far to go along a line that leaves the bodies alone; here the way is short, since
/// nothing stands on a corner before τ is small. Islands with other laws, or larger ones, are left as they
/// are. Source: [ChenMangasarian1996] for following smoothed complementarity, [FukushimaLuoTseng2002] for the
/// cone.
struct SmoothedNewton {
  double tolerance = 1e-10;
  int max_iterations = 150;
  int max_rows = 1500;  ///< a factorization of so many takes two seconds

  template <class Rows>
  using Workspace = SmoothedLaws<Rows>;

  template <class Problem, class Work>
  SolveReport solve(Problem& problem, Work& work) const {
    SolveReport report{.status = Status::max_iterations, .measure = problem.measure()};
    if (!std::isfinite(report.measure.residual))
      return {.status = Status::quarantined, .measure = report.measure};
    if (report.measure.residual <= tolerance) report.status = Status::converged;
    if (report.status == Status::converged || problem.row_count() > max_rows) return report;
    work.keep(problem);
    if (!work.gather(problem)) return report;

    double best = report.measure.residual, shift = least_shift, tau = work.start();
    while (report.factorizations < max_iterations) {
      const double size = work.evaluate(problem, tau);
      const Measure now = problem.measure();
      if (!std::isfinite(size) || !std::isfinite(now.residual)) break;
      if (now.residual < best) {
        best = now.residual;
        work.keep(problem);
      }
      if (best <= tolerance || !work.find_direction(shift)) break;
      ++report.factorizations;
      double least = size, fraction = 0;
      for (double t = 1; t > 1e-4; t /= 2) {
        const double next = work.evaluate_ahead(problem, tau, t);
        if (next < least) least = next, fraction = t;
        if (next < (1 - 1e-4 * t) * size) break;
      }
      work.advance(fraction);
      if ((fraction == 1 && least < 0.3 * size) || least < 0.1 * std::sqrt(tau)) {
        tau *= 0.05;
      } else if (fraction < 0.02) {
        // No way ahead: back to where the corners are rounder, and down again by another path.
        tau *= 4;
        shift = shift < most_shift ? 10 * shift : least_shift;
      }
    }
    work.restore(problem);
    report.measure = problem.measure();
    if (report.measure.residual <= tolerance) report.status = Status::converged;
    return report;
  }

 private:
  /// Added to W, in units of w, in the matrix alone: what keeps rounding in W's null space from steering λ.
  static constexpr double least_shift = 1e-12, most_shift = 1e-10;
};

}  // namespace delassus::inner
