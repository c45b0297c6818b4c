/// Newton's method along the path of smoothed contact laws, around its folds.
#pragma once

#include <delassus/core/cmath.hpp>
#include <delassus/core/expect.hpp>
#include <delassus/core/roles.hpp>
#include <delassus/core/status.hpp>
#include <delassus/solvers/accelerated_gauss_seidel.hpp>
#include <delassus/solvers/inner/path_laws.hpp>
#include <delassus/solvers/solve_report.hpp>

#include <algorithm>
#include <cstddef>
#include <limits>

namespace delassus {

/// Follows the solutions (x, log τ) of `inner::PathRows`, by the length of their curve. It begins with a τ at which all
/// constraints are alike and ends at τ = 0. A step goes along the tangent, then Newton's method across it. Coulomb's law is
/// not monotone, so τ need not fall all along the curve. Where it turns back, a method that lowers τ alone is caught, and
/// this one goes around. Nothing stands on a corner before τ is small. Hyperstatic contacts whose gaps do not fit, among
/// which others go round, are therefore no matter.
///
/// It begins from λ = 0, whatever λ is, and keeps what it was given where it finds no smaller error. A factorization has six
/// unknowns a body, without bodies three a contact. There are tens of them where the curve is plain, a thousand and more
/// where it folds. Islands with laws other than equalities, φ ≥ 0 and Coulomb's are left as they are, and so are coefficients
/// of zero where there are no bodies. Source: [ChenMangasarian1996] for following smoothed complementarity,
/// [FukushimaLuoTseng2002] for the cone, [AllgowerGeorg1990] for the length of the curve.
struct PathNewton {
  using plays = role::Solver;
  double tolerance = 1e-8;    ///< of the criterion
  int max_iterations = 4000;  ///< factorizations
  int max_sweeps =
      4000;  ///< accelerated ones, from the best λ of the path where rounding or a limit ended it
  bool scale_tolerance = false;  ///< tolerance × number of rows
  bool all_verified = false;     ///< every constraint's share below the tolerance, not the sum
  Criterion criterion = Criterion::residual;  ///< what the tolerance is compared with

  static constexpr Needs needs = Needs::tangents;
  /// What outlives a solve: room.
  template <class Rows>
  struct Workspace {
    using T = typename Rows::Scalar;  ///< scalar of W and λ
    inner::PathLaws<T, inner::PathSystem<Rows>> laws;  ///< the curve and its factors
    Array<T> best;  ///< λ of the smallest error so far
    AcceleratedSweeps::Workspace<Rows> sweeps;  ///< room of the sweeps after the path
    void reset(Index rows) {
      best.reserve(std::size_t(rows));
      sweeps.reset(rows);
    }
  };

  SolveOptions options() const { return {tolerance, max_iterations, 0, scale_tolerance, all_verified, criterion}; }
  void check() const {
    inner::expect_at_least_zero("PathNewton: tolerance", tolerance);
    inner::expect_at_least_zero("PathNewton: max_iterations", max_iterations);
    inner::expect_at_least_zero("PathNewton: max_sweeps", max_sweeps);
    inner::expect_measured("PathNewton", criterion);
  }

  template <class T, class Space>
  SolveReport solve(Island<T>& problem, Space& work) const {
    Walk<T, decltype(work.laws)> now{*this, problem, work.laws, work.best};
    now.report.measure = now.best = problem.measure();
    now.report.ended_by = "path";
    problem.notify(0, now.best);
    if (!std::isfinite(now.best.residual)) return {.status = Status::quarantined, .measure = now.best};
    problem.save(work.best);
    if (!meets(now.best, problem) && work.laws.gather(problem)) {
      now.log_tau = 2 * std::log(work.laws.scale());
      if (now.reach_path()) {
        now.follow();
        now.descend();
      }
      problem.load(work.best);
      now.report.measure = problem.measure();
    }
    if (max_sweeps > 0 && !meets(now.report.measure, problem) && !problem.is_out_of_time()) {
      SolveReport report = inner::sweeps_of(options(), max_sweeps, 0).solve(problem, work.sweeps);
      report.factorizations = now.report.factorizations;
      return report;
    }
    now.report.status = options().verdict(now.report.measure, problem.row_count());
    return now.report;
  }

 private:
  static constexpr double least_step = 1e-7;  ///< of the curve's length: below it goes to and fro in rounding

  template <class T, class Laws>
  struct Walk {
    const PathNewton& solver;
    Island<T>& problem;
    Laws& work;
    Array<T>& kept;
    SolveReport report{};
    Measure best{};
    double log_tau = 0, next = 0;  ///< next: log τ of the last evaluation
    double rise = -1;              ///< d log τ/ds

    double tau() const { return std::exp(log_tau); }

    /// |r| at x + δ + s dx/ds, as a share of what the path may be missed by.
    double evaluate(double t, double s) {
      const double tau = std::exp(next), size = work.evaluate(problem, tau, t, s);
      const double rounding = 16 * std::numeric_limits<double>::epsilon() * work.reach();
      return size / (std::sqrt(double(work.row_count())) * std::max(1e-5 * std::sqrt(tau), rounding));
    }
    bool factor() {
      if (report.factorizations >= solver.max_iterations) return false;
      ++report.factorizations;
      return work.factor(std::exp(next));
    }
    /// Newton's step from where |r| is `size`, halved until that falls; |r| at the last try.
    double take_step(double size) {
      work.rows.direction = work.find_direction();
      double least = size;
      for (double t = 1; t > 1e-4 && !(least < size); t /= 2) least = evaluate(t, 0);
      if (least < size) work.advance();
      return least;
    }
    /// Newton's method at the first τ, from x = 0.
    bool reach_path() {
      next = log_tau;
      double size = evaluate(0, 0);
      for (int step = 0; step < 60 && size > 1; ++step) {
        if (!factor()) return false;
        const double least = take_step(size);
        if (!(least < size)) return false;
        size = least;
      }
      return size <= 1;
    }

    void follow() {
      if (!turn()) return;
      double step = 0.5;
      while (!is_done()) {
        int corrections = -1;
        while (corrections < 0) {
          if (report.factorizations >= solver.max_iterations || step < least_step || problem.is_out_of_time())
            return;
          corrections = go_along(step);
          if (corrections < 0) step *= 0.4;
        }
        if (!turn()) return;
        if (corrections <= 2)
          step = std::min(2 * step, 3.0);
        else if (corrections == 3)
          step = std::min(1.3 * step, 3.0);
        else if (corrections > 5)
          step *= 0.7;
      }
    }

    /// Where steps along the curve have drowned in rounding: τ falls by twenty times as often as a Newton step
    /// halves r.
    void descend() {
      next = log_tau;
      for (int step = 0; step < 80 && report.factorizations < solver.max_iterations; ++step) {
        if (problem.is_out_of_time()) return;
        const double size = evaluate(0, 0);
        if (is_done() || !factor()) return;
        const double least = take_step(size);
        if (!(least > 0.5 * size) || least <= 1 || !(least < size)) next -= 3;
      }
    }

    /// A step along the tangent, then across it back to the curve; how many corrections that took, −1: too
    /// many.
    int go_along(double step) {
      next = log_tau + step * rise;
      auto& rows = work.rows;
      rows.direction.assign(rows.direction.size(), 0.0);
      double last = 0;
      for (int k = 0; k < 7; ++k) {
        const double size = evaluate(1, step);
        if (size <= 1) return k;
        if (!std::isfinite(size) || (k > 0 && size > 0.5 * last) || !factor()) return -1;
        last = size;
        rows.newton = work.find_direction();
        work.find_rate(std::exp(next));
        // −J δ + ∂r/∂log τ δσ = −r across the tangent: δ = J⁻¹ r + rate δσ.
        const double change = -work.product(tau(), rows.tangent, rows.newton) / (work.product(tau(), rows.tangent, rows.rate) + rise);
        for (std::size_t n = 0; n < rows.newton.size(); ++n) rows.direction[n] += rows.newton[n] + change * rows.rate[n];
        next += change;
      }
      return -1;
    }

    /// x ← where the last evaluation was, and the tangent there. Along the curve det(−∂r/∂x) and d log τ/ds
    /// change their signs together: that tells ahead from behind where it folds, or nearly meets another,
    /// within a step.
    bool turn() {
      if (!factor()) return false;
      work.find_rate(std::exp(next));
      work.advance();
      log_tau = next;
      auto& rows = work.rows;
      const double length = std::sqrt(work.product(tau(), rows.rate, rows.rate) + 1);
      rise = (work.is_negative() ? 1 : -1) / length;
      for (std::size_t n = 0; n < rows.rate.size(); ++n) rows.tangent[n] = rise * rows.rate[n];
      return std::isfinite(length);
    }

    /// Measures λ by W itself and keeps the best.
    bool is_done() {
      const Measure m = problem.measure();
      problem.notify(report.factorizations, m);
      if (solver.options().error(m) < solver.options().error(best)) {
        best = m;
        problem.save(kept);
      }
      return solver.meets(best, problem) || !std::isfinite(m.residual);
    }
  };

  bool meets(const Measure& m, const auto& problem) const {
    return options().is_done(m, problem.row_count());
  }
};

}  // namespace delassus
