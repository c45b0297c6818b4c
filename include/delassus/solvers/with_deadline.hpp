/// A solve that ends when its time does: the best impulses so far, and the status that says so.
#pragma once

#include <delassus/core/array.hpp>
#include <delassus/core/clock.hpp>
#include <delassus/core/cmath.hpp>
#include <delassus/core/expect.hpp>
#include <delassus/core/if_it_has.hpp>
#include <delassus/core/roles.hpp>
#include <delassus/core/wrapping.hpp>
#include <delassus/rows/impulses.hpp>
#include <delassus/solvers/inner/solve_timer.hpp>
#include <delassus/solvers/island.hpp>
#include <delassus/solvers/solve_report.hpp>

#include <algorithm>
#include <cstddef>
#include <limits>

namespace delassus {
namespace inner {

/// Room for a solver, and for the best that it has measured.
template <class T, class Space>
struct TimedSpace {
  Space solver;
  Array<T> best;
  Array<Attempts> attempts;                                 ///< of each island
  double until = std::numeric_limits<double>::quiet_NaN();  ///< NaN before the first island

  void reset(Index rows) {
    reset_if_it_can(solver, rows);
    best.reserve(std::size_t(rows));
    const auto islands = std::size_t(rows);  // at most
    if (attempts.capacity() < islands) attempts.reserve(2 * islands);
  }
  /// A step that is solved again has one budget.
  void begin_step() {
    begin_step_if_it_can(solver);
    until = std::numeric_limits<double>::quiet_NaN();
  }
  void memory(auto& archive) { archive(attempts); }
};

}  // namespace inner

/// `WithDeadline{AcceleratedGaussSeidel{.tolerance = 1e-6}, 1e-3}` gives the islands of a step one millisecond together, and
/// all its solves. The clock is read after each sweep, and inside long sweeps, measures and factorizations of Newton's method in the velocities of
/// the bodies. It is read before each of those too, which is not begun where it would end too late.
///
/// When the time is up, what is half done is let go, and the iterate of the smallest measured residual is returned, with
/// status `deadline`. (The time leaves what giving an iterate back takes, `load_share` of a sweep.) Islands that come later
/// still get their `min_iterations` sweeps and a measure, since a contact that is new has no impulse before its first sweep.
template <class Solver = inner::Absent, Clock C = SteadyClock>
struct WithDeadline {
  using plays = role::Solver;
  static constexpr unsigned layers = inner::layers_of<Solver> | inner::layer::deadline;
  Solver solver{};  ///< asks whether its time is up
  double budget = std::numeric_limits<double>::infinity();  ///< s from the moment the first island is begun
  C clock{};  ///< s, read while it solves
  double deadline =
      std::numeric_limits<double>::infinity();  ///< on `clock`, s; the earlier of the two counts

  static constexpr Needs needs = inner::needs_of<Solver>;
  template <class Rows>
  using Workspace = inner::TimedSpace<typename Rows::Scalar, typename Solver::template Workspace<Rows>>;

  void check() const {
    solver.check();
    inner::expect_at_least_zero("WithDeadline: budget", budget, "s");
    DELASSUS_EXPECT(!std::isnan(deadline),
                    "WithDeadline: the deadline must be a number of seconds on its clock");
  }

  template <class T, class Space>
  SolveReport solve(Island<T>& problem, Space& work) const {
    if (std::isnan(work.until))
      work.until = std::isinf(budget) ? deadline : std::min(deadline, clock.now() + budget);
    const auto island = std::size_t(problem.island());
    if (work.attempts.size() <= island) work.attempts.resize(island + 1);
    inner::Attempts& attempts = work.attempts[island];
    inner::SolveTimer<T> timer(&clock, [](const void* which) { return static_cast<const C*>(which)->now(); }, work.until, work.best,
                               attempts.is_due(), problem.cost_of_load());
    problem.set_timer(&timer);
    SolveReport report = solver.solve(problem, work.solver);
    problem.set_timer(nullptr);
    const bool is_half_done = timer.has_let_go() && report.status != Status::infeasible;
    const bool is_late = is_half_done || (timer.was_late() && report.status == Status::max_iterations);
    if (timer.has_attempted()) attempts.note(timer.was_of_use() || !is_late);
    if (!is_late) return report;
    report.status = Status::deadline;
    if (is_half_done || timer.least().residual < report.measure.residual) {
      problem.load(timer.best());
      report.measure = timer.least();
    }
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

/// `WithDeadline{solver}`: no limit.
template <class Solver>
WithDeadline(Solver) -> WithDeadline<Solver>;
/// A number before the solver; refused by the checks.
template <class Solver>
WithDeadline(double, Solver) -> WithDeadline<double>;  // the number first: the loop's checks say so
/// `WithDeadline{solver, budget}`.
template <class Solver>
WithDeadline(Solver, double) -> WithDeadline<Solver>;
/// `WithDeadline{solver, budget, clock}`.
template <class Solver, Clock C>
WithDeadline(Solver, double, C) -> WithDeadline<Solver, C>;
/// `WithDeadline{solver, budget, clock, deadline}`.
template <class Solver, Clock C>
WithDeadline(Solver, double, C, double) -> WithDeadline<Solver, C>;

}  // namespace delassus
