/// Newton's method on convex problems whose fixed point is Coulomb's law: slow, and independent of the
/// sweeps.
#pragma once

#include <delassus/core/cmath.hpp>
#include <delassus/core/status.hpp>
#include <delassus/solvers/inner/convex_space.hpp>
#include <delassus/solvers/measure.hpp>
#include <delassus/solvers/solve_report.hpp>

#include <algorithm>
#include <limits>

namespace delassus::inner {

/// Proximal points of `ConvexSpace`, each found by Newton's method with a search for the minimum along its
/// directions; then λ̂ ← λ(u) and s ← |u_t|. At the fixed point nothing is left of ε, nor of the given s. Now
/// and then proximal points of the laws as they are take over, as far as they lead. No law is solved for one
/// constraint with the others held. Source: [AcaryEtAl2011] for the fixed point, [Rockafellar1976] for the
/// proximal point.
struct ConvexNewton {
  double tolerance = 1e-10;
  int max_iterations = 2000;  ///< convex problems
  double least = 1e-6;        ///< ε where the residual is small: less would magnify the rounding of u
  bool from_slips = false;    ///< of the given λ, and nothing else of it; else from all of λ
  int patience = 50;          ///< convex problems before the slips follow one that is half solved

  static constexpr Needs needs = Needs::convex_tangents;
  template <class Rows>
  using Workspace = ConvexSpace<typename Rows::Scalar, std::max(1, Rows::widest)>;

  template <class T, class Work>
  SolveReport solve(Island<T>& problem, Work& work) const {
    Search<T, Work> now{problem, work};
    now.report.measure = now.best = problem.measure();
    now.report.status = Status::max_iterations;
    if (!std::isfinite(now.best.residual)) return {.status = Status::quarantined, .measure = now.best};
    if (!work.gather(problem)) return now.report;
    work.keep();
    if (from_slips && solve_of_slips(now)) return now.report;
    double epsilon = coarse, far = 1, last = 1, polished = 1;
    for (int k = 0, since = 0; k < max_iterations; ++k) {
      now.report.factorizations += work.descend(problem, epsilon);
      if (is_done(now)) return now.report;
      const double residual = now.report.measure.residual;
      const bool drifts = residual < 1e-4 && residual > 0.8 * last && residual < 1.05 * last;
      if (drifts)
        work.extrapolate(problem, far);
      else
        work.recentre();
      far = drifts ? 2 * far : std::max(0.25 * far, 1.0);
      last = residual;
      epsilon = std::clamp(residual, least, coarse);
      if (drifts || (residual > 0.1 * polished && ++since < 8)) continue;
      since = 0;
      polished = residual;
      if (polish(now)) return now.report;
    }
    work.hand_over(problem, work.best);
    now.report.measure = problem.measure();
    return now.report;
  }

 private:
  static constexpr double coarse =
      0.1;  ///< ε while the residual is large: far off a small one flips rows to and fro

  static constexpr double same_slips = 1e-3;  ///< of all velocities: one motion, to what tolerances leave of it

  template <class T, class Work>
  struct Search {
    Island<T>& problem;
    Work& work;
    SolveReport report{};
    Measure best{};
  };

  /// The convex problem of the slips that the given λ has, from λ = 0; true when its solution is one of the
  /// law. Those slips are known to the λ's own tolerance, and where bodies are wedged |u_t| ↦ |u_t| magnifies
  /// what is missing: from the solution, after a while from less than what the law is missed by, the slips
  /// follow for some turns. Where impulses are redundant and gaps do not fit, proximal points go a long way by
  /// small steps: `polish` may jump to its end.
  bool solve_of_slips(auto& now) const {
    constexpr int turns = 20, between_turns = 10, between_polishes = 20, between_marks = 50;
    now.work.forget(now.problem);
    now.work.keep();
    now.best.residual = std::numeric_limits<double>::infinity();
    double epsilon = coarse, marked = epsilon;
    for (int k = 1, turned = 0; k <= max_iterations && turned <= turns; ++k) {
      now.report.factorizations += now.work.descend(now.problem, epsilon);
      if (is_done(now)) return true;
      const double left = now.work.distance(epsilon), residual = now.report.measure.residual;
      const bool is_near = left < std::min(10 * tolerance, 0.5 * residual);
      const bool is_solved =
          left < 0.1 * tolerance || (is_near && k > patience && k % between_turns == 0);
      now.work.recentre(!is_solved);
      turned += is_solved;
      if (k % between_marks == 0) {
        if (turned == 0 && left > std::max(0.8 * marked, tolerance)) break;
        marked = left;
      }
      if (k % between_polishes == 0 && polish(now, true)) return true;
      epsilon = std::clamp(std::min(left, residual), least, coarse);
    }
    if (!(now.best.residual <= tolerance)) return false;
    now.work.hand_over(now.problem, now.work.best);
    return is_done(now, now.problem.measure());
  }

  /// Hands λ over, measures it by W itself, and keeps the best; true when that is within the tolerance.
  bool is_done(auto& now) const {
    return is_done(now, now.work.measure(now.problem));
  }
  bool is_done(auto& now, const Measure& measure) const {
    now.report.measure = measure;
    if (now.report.measure.residual < now.best.residual) {
      now.best = now.report.measure;
      now.work.keep();
    }
    if (!(now.report.measure.residual <= tolerance)) return false;
    now.report.status = Status::converged;
    return true;
  }

  /// Proximal points of the laws as they are, while each halves the residual; where that does not end it, or with
  /// other slips than those that stay, which is another motion, λ is what it was.
  bool polish(auto& now, bool keeps_slips = false) const {
    now.work.mark(now.problem);
    double before = now.report.measure.residual, epsilon = 1e-3;
    for (int k = 0; k < 12; ++k) {
      now.work.restart(now.problem, keeps_slips);
      now.report.factorizations += now.work.polish(now.problem, epsilon);
      if (is_done(now)) {
        if (!keeps_slips || now.work.slip_change(now.problem) < same_slips) return true;
        now.report.status = Status::max_iterations;
        break;
      }
      if (!(now.report.measure.residual < 0.5 * before)) break;
      before = now.report.measure.residual;
      now.work.mark(now.problem);
      epsilon = std::max(0.03 * epsilon, 1e-7);
    }
    now.work.hand_over(now.problem, now.work.before);
    now.work.restart(now.problem, keeps_slips);
    return false;
  }
};

}  // namespace delassus::inner
