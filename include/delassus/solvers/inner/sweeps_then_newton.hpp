/// Sweeps on a dense W, and Newton's method where contacts jam.
#pragma once

#include <delassus/rows/impulses.hpp>
#include <delassus/solvers/accelerated_gauss_seidel.hpp>
#include <delassus/solvers/inner/contact_space.hpp>
#include <delassus/solvers/inner/newton_in_impulses.hpp>
#include <delassus/solvers/solve_report.hpp>

#include <algorithm>
#include <utility>

namespace delassus::inner {

/// Where joints press contacts on each other from several sides, as in a knot that is drawn tight, sweeps may
/// end at a residual near one. What `first` of them did not end is for Newton's method in the impulses, from
/// where they came to and then from λ = 0: a jam may be far from the last step's impulses. Then the rest of
/// the sweeps, from the smallest error of all. Each of both may cost half of what that rest does, so that no
/// solve takes more than some twice the time of its sweeps alone. Without contacts, with a law that Newton's
/// method has no form of, or without a rest, there are sweeps alone.
struct SweepsThenNewton {
  using Newton = NewtonInImpulses;
  static constexpr int first = 400;
  AcceleratedSweeps sweeps;  ///< and how many in all

  template <class T>
  struct Space {
    Newton::Space<T> newton;
    Array<T> best;
    /// What Newton's method needs is made where it acts.
    void reset(Index rows) { newton.sweeps.reset(rows); }
  };

  template <class T>
  SolveReport solve(Island<T>& problem, Space<T>& work) const {
    const int most = factorizations(problem);
    return most > 0 ? solve(problem, work, most) : sweeps.solve(problem, work.newton.sweeps);
  }

 private:
  template <class T>
  SolveReport solve(Island<T>& problem, Space<T>& work, int factorizations) const {
    SolveReport report = newton(first, factorizations).solve(problem, work.newton);
    const auto goes_on = [&] { return report.status == Status::max_iterations && !problem.is_out_of_time(); };
    if (report.factorizations > 0 && goes_on()) {
      problem.save(work.best);
      problem.clear();
      if (!add(newton(1, factorizations).solve(problem, work.newton), report)) problem.load(work.best);
    }
    if (goes_on()) {
      auto rest = sweeps;
      rest.max_iterations -= report.sweeps;
      add(rest.solve(problem, work.newton.sweeps), report);
    }
    return report;
  }

  /// The later report with the work of both; the error is that of the better. Whether that is the later.
  bool add(SolveReport later, SolveReport& report) const {
    const SolveOptions limits = sweeps.options();
    const bool is_better =
        later.status == Status::infeasible || limits.error(later.measure) < limits.error(report.measure);
    later.sweeps += report.sweeps;
    later.factorizations += report.factorizations;
    if (!is_better) later.measure = report.measure, later.status = report.status;
    report = later;
    return is_better;
  }

  /// That one run of Newton's method may make; none where it cannot act.
  template <class T>
  int factorizations(const Island<T>& problem) const {
    bool is_known = sweeps.max_iterations > first, has_contacts = false;
    for (const Span<T>& span : problem) {
      is_known = is_known && ContactSpace<T>::knows(*span.pool);
      has_contacts = has_contacts || span.pool->table->friction;
    }
    if (!is_known || !has_contacts) return 0;
    const double rest = sweeps.max_iterations - first;
    return std::min(100, int(0.5 * rest / Newton::cost_in_sweeps(problem.row_count())));
  }
  Newton newton(int swept, int factorizations) const {
    Newton solver{sweeps, factorizations};
    solver.sweeps.max_iterations = swept;
    solver.sweeps.min_iterations = std::min(sweeps.min_iterations, swept);
    return solver;
  }
};

}  // namespace delassus::inner
