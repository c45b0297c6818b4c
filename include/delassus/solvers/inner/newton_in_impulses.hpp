/// Newton's method in the impulses, inside a proximal point iteration, on a dense W.
#pragma once

#include <delassus/core/roles.hpp>
#include <delassus/rows/impulses.hpp>
#include <delassus/solvers/accelerated_gauss_seidel.hpp>
#include <delassus/solvers/inner/contact_space.hpp>
#include <delassus/solvers/inner/halve_step.hpp>
#include <delassus/solvers/island.hpp>
#include <delassus/solvers/solve_report.hpp>

#include <algorithm>

namespace delassus::inner {

/// Accelerated sweeps first. Where they did not end the solve, the proximal point λ̂ ← λ, each found by
/// Newton's method on F of `ContactSpace`, with steps halved until |F| falls, while ε shrinks. The matrix is
/// dense, of the rows that carry: one factorization of n rows costs n³/3 multiplications. The smallest
/// measured error is kept. Source: [Rockafellar1976] for the proximal point, [QiSun1993] for Newton's method
/// on it, [AcaryBremondHuber2018] for both.
struct NewtonInImpulses {
  using plays = role::Solver;
  AcceleratedSweeps sweeps;  ///< before the first factorization; their tolerance is that of all
  int max_factorizations = 100;

  static constexpr Needs needs = Needs::sweeps;
  template <class T>
  struct Space {
    ContactSpace<T> space;
    Array<T> best;
    SweepSpace<T, SweepsAlone::Space<T, 0>> sweeps;
    void reset(Index rows) {
      sweeps.reset(rows);
      best.reserve(std::size_t(rows));
    }
  };
  template <class Rows>
  using Workspace = Space<typename Rows::Scalar>;

  /// What a factorization takes with all around it, in sweeps on a dense W of n rows, n² multiplications
  /// each: n³/3, some three products for the matrix, and those of the halved steps.
  static double cost_in_sweeps(int rows) { return rows / 3.0 + 10; }

  template <class T>
  SolveReport solve(Island<T>& problem, Space<T>& work) const {
    const SolveOptions limits = sweeps.options();
    SolveReport report = sweeps.solve(problem, work.sweeps);
    if (report.status != Status::max_iterations || problem.is_out_of_time()) return report;
    if (problem.may_attempt(cost_in_sweeps(problem.row_count())) && work.space.gather(problem)) {
      const double before = limits.error(report.measure);
      problem.save(work.best);
      descend(problem, work, report);
      problem.load(work.best);
      problem.attempted(limits.error(report.measure) < 0.5 * before);
      report.ended_by = "newton";
    }
    report.status = limits.verdict(report.measure, problem.row_count());
    return report;
  }

 private:
  template <class T>
  void descend(Island<T>& problem, Space<T>& work, SolveReport& report) const {
    auto& space = work.space;
    const SolveOptions limits = sweeps.options();
    const int rows = problem.row_count();
    double epsilon = 1e-4, last = limits.error(report.measure);
    space.take(problem);
    for (int stalled = 0; stalled < 8 && !limits.is_done(report.measure, rows);) {
      if (report.factorizations >= max_factorizations || !problem.has_time_for(cost_in_sweeps(rows))) return;
      const double fall = approach(problem, space, epsilon, report);
      space.give(problem);
      const Measure now = problem.measure();
      problem.notify(report.sweeps + report.factorizations, now);
      const bool is_better = limits.error(now) < limits.error(report.measure);
      if (is_better) {
        report.measure = now;
        problem.save(work.best);
      }
      stalled = is_better ? 0 : stalled + 1;
      if (!(limits.error(now) <= 2 * last)) problem.load(work.best);  // lost: from the best again
      epsilon = fall < 0.3 ? std::max(0.1 * epsilon, 1e-10) : std::min(10 * epsilon, 10.0);
      last = std::min(limits.error(now), 2 * last);
      space.take(problem);
    }
  }

  /// Newton's method around one λ̂, until |F| has fallen by a hundred or does not fall; how far it fell.
  template <class T>
  double approach(Island<T>& problem, ContactSpace<T>& space, double epsilon, SolveReport& report) const {
    const double work = cost_in_sweeps(problem.row_count()), first = space.evaluate(epsilon);
    double size = first;
    for (int step = 0; step < 12 && size > 1e-2 * first && report.factorizations < max_factorizations;
         ++step) {
      if (step > 0 && !problem.has_time_for(work)) break;
      if (!space.find_direction(epsilon)) return 1;
      ++report.factorizations;
      const double before = size, t = halve_step(size, 13, [&](double part) { return space.evaluate(epsilon, part); });
      if (!(size < 0.999 * before)) return before / first;
      space.advance(t);
    }
    return first > 0 ? size / first : 0;
  }
};

}  // namespace delassus::inner
