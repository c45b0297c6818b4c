/// A solve that ends when its time does: the best impulses so far, and the status that says so.
#pragma once

#include <delassus/core/array.hpp>
#include <delassus/core/clock.hpp>
#include <delassus/core/expect.hpp>
#include <delassus/core/roles.hpp>
#include <delassus/core/wrapping.hpp>
#include <delassus/rows/impulses.hpp>
#include <delassus/solvers/inner/timed_problem.hpp>
#include <delassus/solvers/solve_report.hpp>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <limits>

namespace delassus {

/// `WithDeadline{AcceleratedGaussSeidel{.tolerance = 1e-6}, 1e-3}` gives the islands of a step one
/// millisecond together. The clock is read after each sweep, inside long sweeps, measures and factorizations
/// of Newton's method in the velocities of the bodies, and before each of those, which is not begun where it
/// would end too late. When the time is up, but for what giving an iterate back takes (`load_share` of a
/// sweep), what is half done is let go, and the iterate of the smallest measured residual is returned, with
/// status `deadline`; islands that come later still get their
/// `min_iterations` sweeps and a measure, since a contact that is new has no impulse before its first sweep.
template <class Solver = inner::Absent, Clock C = SteadyClock>
struct WithDeadline {
  using plays = role::Solver;
  static constexpr unsigned layers = inner::layers_of<Solver> | inner::layer::deadline;
  Solver solver{};
  double budget = std::numeric_limits<double>::infinity();  ///< s from the moment the first island is begun
  C clock{};
  double deadline =
      std::numeric_limits<double>::infinity();  ///< on `clock`, s; the earlier of the two counts

  template <class Rows>
  struct Workspace {
    typename Solver::template Workspace<Rows> solver;
    Impulses<Rows> best;
    Array<inner::Attempts> attempts;                    ///< of each island
    double until = std::numeric_limits<double>::quiet_NaN();  ///< NaN before the first island

    void reset(const Rows& rows) {
      if constexpr (requires { solver.reset(rows); }) solver.reset(rows);
      best.resize_like(rows);
      const auto islands = std::size_t(rows.row_count());  // at most
      if (attempts.capacity() < islands) attempts.reserve(2 * islands);
      until = std::numeric_limits<double>::quiet_NaN();
    }
    void memory(auto& archive) { archive(attempts); }
  };

  void check() const {
    solver.check();
    inner::expect_at_least_zero("WithDeadline: budget", budget, "s");
    DELASSUS_EXPECT(!std::isnan(deadline),
                    "WithDeadline: the deadline must be a number of seconds on its clock");
  }

  SolveReport solve(auto& problem, auto& work) const {
    if (std::isnan(work.until))
      work.until = std::isinf(budget) ? deadline : std::min(deadline, clock.now() + budget);
    const auto island = std::size_t(problem.island());
    if (work.attempts.size() <= island) work.attempts.resize(island + 1);
    inner::Attempts& attempts = work.attempts[island];
    inner::TimedProblem timed(problem, clock, work.until, work.best, attempts.is_due());
    SolveReport report = solver.solve(timed, work.solver);
    const bool is_half_done = timed.has_let_go() && report.status != Status::infeasible;
    const bool is_late = is_half_done || (timed.was_late() && report.status == Status::max_iterations);
    if (timed.has_attempted()) attempts.note(timed.was_of_use() || !is_late);
    if (!is_late) return report;
    report.status = Status::deadline;
    if (is_half_done || timed.least().residual < report.measure.residual) report.measure = timed.restore_best();
    return report;
  }
};

/// Around what is no solver, as in `WithDeadline{1e-3}`, or has a deadline; the loop's checks say so.
template <class Solver, Clock C>
  requires(!inner::Fills<Solver, role::Solver, inner::layer::deadline>)
struct WithDeadline<Solver, C> : inner::Hollow {
  using plays = role::Solver;
  using inner::Hollow::Hollow;
};

template <class Solver>
WithDeadline(Solver) -> WithDeadline<Solver>;
template <class Solver>
WithDeadline(double, Solver) -> WithDeadline<double>;  // the number first: the loop's checks say so
template <class Solver>
WithDeadline(Solver, double) -> WithDeadline<Solver>;
template <class Solver, Clock C>
WithDeadline(Solver, double, C) -> WithDeadline<Solver, C>;
template <class Solver, Clock C>
WithDeadline(Solver, double, C, double) -> WithDeadline<Solver, C>;

}  // namespace delassus
