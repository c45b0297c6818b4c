/// Newton's method in the velocities of the bodies, inside a proximal point iteration on the impulses.
#pragma once

#include <delassus/core/expect.hpp>
#include <delassus/core/roles.hpp>
#include <delassus/solvers/accelerated_gauss_seidel.hpp>
#include <delassus/solvers/criteria.hpp>
#include <delassus/solvers/inner/body_space.hpp>
#include <delassus/solvers/island_problem.hpp>
#include <delassus/solvers/solve_report.hpp>

#include <algorithm>
#include <cmath>

namespace delassus {

/// Outside, the proximal point: λ̂ ← λ, where λ meets the laws of d + W λ + ε w (λ − λ̂), w_i = tr(W_ii)/rows,
/// and ε shrinks by 0.01 a time, where that is slow by what it has to. Inside, Newton's method for the velocities of the bodies with F and J of
/// `inner::BodySpace`, each step halved until the rows see less of F. At the fixed point nothing is left of
/// ε: the laws are met as they are, Coulomb's too.
///
/// The number of factorizations hardly grows with the height of a stack or the ratio of masses; one costs a
/// few sweeps. Where Newton's method stalls, accelerated sweeps lead on from the best λ; an island that it
/// cannot treat (a law without `tangent`, bodies coupled by springs under an implicit integrator) is swept
/// throughout, and one that it did not bring to the tolerance is swept from its start. The smallest measured
/// residual is what is kept. Source: [Rockafellar1976] for the proximal point, [QiSun1993] for
/// Newton's method on it, [AcaryBremondHuber2018] for both together, [AlartCurnier1991] for the contact's equations.
template <class Criterion = Residual>
struct BasicProximalNewton {
  static_assert(
      Criterion::needs_measure,
      "delassus: ProximalNewton stops on a measured error; use the criterion Residual or SiconosError");
  using plays = role::Solver;
  double tolerance = 1e-8;       ///< of the criterion
  int max_iterations = 60;       ///< factorizations; then come the sweeps
  int min_iterations = 1;        ///< factorizations even when the warm start is within the tolerance
  int max_sweeps = 4000;         ///< in all, of an island where Newton's method stalls or cannot act
  bool scale_tolerance = false;  ///< tolerance × number of rows
  bool all_verified = false;     ///< every constraint's share below the tolerance, not the sum

  template <class Rows>
  struct Workspace {
    inner::BodySpace<Rows> body;
    typename BasicAcceleratedGaussSeidel<Criterion>::template Workspace<Rows> sweeps;
    void reset(const Rows& rows) { sweeps.reset(rows); }
  };

  void check() const {
    DELASSUS_EXPECT(tolerance >= 0, "ProximalNewton: tolerance " + inner::text(tolerance) + " must be >= 0");
    DELASSUS_EXPECT(max_iterations >= 0,
                    "ProximalNewton: max_iterations " + inner::text(max_iterations) + " must be >= 0");
    DELASSUS_EXPECT(max_sweeps >= 0,
                    "ProximalNewton: max_sweeps " + inner::text(max_sweeps) + " must be >= 0");
  }

  template <class Problem, class Workspace>
  SolveReport solve(Problem& problem, Workspace& work) const {
    auto& body = work.body;
    if (!body.gather(problem)) return sweep(problem, work, max_sweeps, min_iterations);
    Search<Problem> now{problem, problem.row_count()};
    now.report.measure = now.best = body.measure(problem);
    problem.tell(0, now.best);
    if (!std::isfinite(now.best.residual)) return {.status = Status::quarantined, .measure = now.best};
    if (min_iterations == 0 && is_done(now.best, now.rows)) return finish(now);

    double epsilon = now.best.residual > 1e-2 ? 1e-5 : 1e-7;  // a warm start needs no care
    bool is_slow = false;
    double centre = body.error();                             // of λ̂
    now.least = centre;
    for (int outer = 0, patience = 20; outer < max_iterations && has_time(now); ++outer) {
      const int before = now.report.factorizations;
      const bool is_well = descend(now, body, epsilon);
      note(now, body);
      if (is_done(now.report.measure, now.rows)) {
        body.hand_over(
            problem, [](const auto& c) -> const auto& { return c.lambda; });
        now.report.measure = problem.measure();  // by W itself
        if (is_done(now.report.measure, now.rows)) return finish(now);
        if (!restart(now, body)) break;
      } else if (is_well && body.error() < 1.5 * centre) {
        body.recentre();
        // One step of Newton's method was enough, and yet λ has hardly come nearer: impulses through what is light to
        // what is heavy, which move by 1/(1 + ε r) of their way, r the ratio of the masses.
        is_slow = is_slow || (now.report.factorizations == before + 1 && body.error() > 0.5 * centre);
        // The error goes by ε/(1/r + ε) a time: ε for 2e-4 of it next time.
        if (is_slow)
          epsilon = std::clamp(2e-4 * centre / std::max(body.error(), 1e-300) * epsilon, 1e-12, epsilon);
        else
          epsilon = std::max(0.01 * epsilon, 1e-10);
      } else {
        epsilon = std::min(20 * epsilon, 1.0);
        body.hand_over(
            problem, [](const auto& c) -> const auto& { return c.best; });
        patience = std::min(2 * patience, max_sweeps - now.report.sweeps);
        if (patience <= 0) break;
        now.report.sweeps += sweep(problem, work, patience, 1).sweeps;
        if (!restart(now, body)) break;
        if (is_done(now.report.measure, now.rows)) return finish(now);
      }
      centre = body.error();
    }
    return give_up(now, work);
  }

 private:
  template <class Problem>
  struct Search {
    Problem& problem;
    int rows;
    SolveReport report{};
    Measure best{};
    double least = 0;  ///< the error of `best`
    bool is_late = false;
  };

  /// Newton's method around one λ̂, until F has fallen by 1e4 or λ(u) is good enough; false when it stalls.
  template <class Problem, class Body>
  bool descend(Search<Problem>& now, Body& body, double epsilon) const {
    double size = body.evaluate(now.problem, epsilon, 0);
    body.close_what_touches(now.problem, epsilon, body.error());
    const double first = size;
    for (int step = 0; step < 8 && has_time(now); ++step) {
      if (!(size > 0)) break;
      if (!body.find_direction()) return false;
      ++now.report.factorizations;
      const double before = size;
      const double fraction = search_line(now.problem, body, epsilon, size);
      body.advance(fraction);
      now.report.measure = body.measure(now.problem);
      now.problem.tell(now.report.sweeps + now.report.factorizations, now.report.measure);
      if (is_done(now.report.measure, now.rows) || size < 1e-4 * first) break;
      if (!(size <= 0.99 * before)) return false;
    }
    now.report.measure = body.measure(now.problem);
    return std::isfinite(size);
  }

  template <class Problem, class Body>
  static void note(Search<Problem>& now, Body& body) {
    if (!(body.error() < now.least)) return;
    now.least = body.error();
    now.best = now.report.measure;
    body.keep();
  }

  /// Halves the step until the size of F has fallen by a thousandth of it, else takes the best; leaves F
  /// evaluated there.
  template <class Problem, class Body>
  static double search_line(const Problem& problem, Body& body, double epsilon, double& size) {
    double best = 0, least = std::numeric_limits<double>::infinity(), fraction = 1;
    for (int halving = 0; halving < 14; ++halving, fraction *= 0.5) {
      const double trial = body.evaluate(problem, epsilon, fraction);
      if (trial <= (1 - 1e-3 * fraction) * size) {
        size = trial;
        return fraction;
      }
      if (trial < least) least = trial, best = fraction;
    }
    size = body.evaluate(problem, epsilon, best);
    return best;
  }

  /// Begins anew from the λ that the rows have; false when nothing can be begun from there.
  template <class Problem, class Body>
  static bool restart(Search<Problem>& now, Body& body) {
    if (!body.restart(now.problem)) return false;
    now.report.measure = body.measure(now.problem);
    note(now, body);
    return true;
  }

  /// The tolerance was not met: what is left of the sweeps leads on from the best λ.
  template <class Problem, class Workspace>
  SolveReport give_up(Search<Problem>& now, Workspace& work) const {
    work.body.hand_over(
        now.problem, [](const auto& c) -> const auto& { return c.best; });
    const int left = max_sweeps - now.report.sweeps;
    if (!now.is_late && left > 0) {
      const SolveReport swept = sweep(now.problem, work, left, 1);
      now.report.sweeps += swept.sweeps;
      now.report.measure = swept.measure;
      if (swept.status == Status::infeasible) {
        now.report.status = swept.status;
        return now.report;
      }
    } else {
      now.report.measure = now.problem.measure();
    }
    return finish(now);
  }

  template <class Problem, class Workspace>
  SolveReport sweep(Problem& problem, Workspace& work, int most, int least) const {
    const BasicAcceleratedGaussSeidel<Criterion> solver{.tolerance = tolerance,
                                                        .max_iterations = most,
                                                        .min_iterations = least,
                                                        .scale_tolerance = scale_tolerance,
                                                        .all_verified = all_verified};
    return solver.solve(problem, work.sweeps);
  }

  template <class Problem>
  bool has_time(Search<Problem>& now) const {
    if (now.report.factorizations >= max_iterations) return false;
    if (now.report.factorizations >= std::max(1, min_iterations))
      now.is_late = now.is_late || now.problem.is_out_of_time();
    return !now.is_late;
  }
  bool is_done(const Measure& m, int rows) const {
    return inner::is_within<Criterion>(*this, m, rows) || m.residual <= m.floor;
  }
  template <class Problem>
  SolveReport finish(Search<Problem>& now) const {
    now.report.status = inner::verdict<Criterion>(*this, now.report.measure, now.rows);
    return now.report;
  }
};

using ProximalNewton = BasicProximalNewton<>;

}  // namespace delassus
