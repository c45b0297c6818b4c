/// A solve that ends when its time does: the best impulses so far, and the status that says so.
#pragma once

#include <delassus/core/clock.hpp>
#include <delassus/core/expect.hpp>
#include <delassus/core/roles.hpp>
#include <delassus/solvers/island_problem.hpp>
#include <delassus/solvers/solve_report.hpp>

#include <algorithm>
#include <cmath>
#include <limits>

namespace delassus {
namespace inner {

/// An island that looks at the clock after each sweep, and before what takes longer, and sets the best
/// measured impulses aside.
template <class Problem, class C, class Best>
class TimedProblem : public Problem {
 public:
  TimedProblem(const Problem& problem, const C& clock, double deadline, Best& best)
      : Problem(problem), clock_(clock), deadline_(deadline), best_(best) {}

  /// Asked after every sweep.
  bool is_out_of_time() {
    const double now = clock_.now();
    if (is_sweep_) {
      swept_ += now - last_;
      ++sweeps_;
    }
    last_ = now;
    is_sweep_ = true;
    is_late_ = is_late_ || now >= deadline_;
    return is_late_;
  }
  /// Whether what takes as long as so many sweeps would end before the deadline. One that is not begun does
  /// not make the solve late: shorter work may still be done.
  bool has_time_for(double sweeps) {
    const double now = clock_.now(), pace = sweeps_ > 0 ? swept_ / sweeps_ : 0;
    is_sweep_ = false;
    is_late_ = is_late_ || now >= deadline_;
    return !is_late_ && now + sweeps * pace < deadline_;
  }
  Measure measure() {
    const Measure m = Problem::measure();
    if (m.residual < least_.residual) {
      least_ = m;
      this->save(best_);
    }
    return m;
  }
  bool was_late() const { return is_late_; }
  const Measure& least() const { return least_; }

 private:
  const C& clock_;
  double deadline_;
  Best& best_;
  Measure least_{.residual = std::numeric_limits<double>::infinity()};
  bool is_late_ = false;
  bool is_sweep_ = false;        ///< there was nothing else since the last look
  double last_ = 0, swept_ = 0;  ///< s
  int sweeps_ = 0;
};

}  // namespace inner

/// `WithDeadline{AcceleratedGaussSeidel{.tolerance = 1e-6}, 1e-3}` gives the islands of a step one
/// millisecond together. The clock is read after each sweep, and before each factorization of Newton's method
/// in the velocities of the bodies, which is not begun where it would end too late. When the time is up the
/// iterate of the smallest measured residual is returned, with status `deadline`; islands that come later
/// still get their `min_iterations` sweeps, since a contact that is new has no impulse before its first
/// sweep.
template <class Solver, Clock C = SteadyClock>
struct WithDeadline {
  using plays = role::Solver;
  Solver solver{};
  double budget = std::numeric_limits<double>::infinity();  ///< s from the moment the first island is begun
  C clock{};
  double deadline =
      std::numeric_limits<double>::infinity();  ///< on `clock`, s; the earlier of the two counts

  template <class Rows>
  struct Workspace {
    typename Solver::template Workspace<Rows> solver;
    Impulses<Rows> best;
    double until = std::numeric_limits<double>::quiet_NaN();  ///< NaN before the first island

    void reset(const Rows& rows) {
      if constexpr (requires { solver.reset(rows); }) solver.reset(rows);
      best.resize_like(rows);
      until = std::numeric_limits<double>::quiet_NaN();
    }
  };

  void check() const {
    solver.check();
    DELASSUS_EXPECT(budget >= 0, "WithDeadline: budget " + inner::text(budget) + " s must be >= 0");
    DELASSUS_EXPECT(!std::isnan(deadline),
                    "WithDeadline: the deadline must be a number of seconds on its clock");
  }

  template <class Problem, class Workspace>
  SolveReport solve(Problem& problem, Workspace& work) const {
    if (std::isnan(work.until))
      work.until = std::isinf(budget) ? deadline : std::min(deadline, clock.now() + budget);
    inner::TimedProblem timed(problem, clock, work.until, work.best);
    SolveReport report = solver.solve(timed, work.solver);
    if (!timed.was_late() || report.status != Status::max_iterations) return report;
    report.status = Status::deadline;
    if (timed.least().residual < report.measure.residual) {
      timed.load(work.best);
      report.measure = timed.least();
    }
    return report;
  }
};

/// Around what is no solver, as in `WithDeadline{1e-3}`; the loop's checks say so.
template <class Solver, Clock C>
  requires(!Plays<Solver, role::Solver>)
struct WithDeadline<Solver, C> {
  using plays = role::Solver;
  using no_solver = Solver;
  Solver solver{};
  double budget = std::numeric_limits<double>::infinity();
  C clock{};
};

template <class Solver>
WithDeadline(Solver) -> WithDeadline<Solver>;
template <class Solver>
WithDeadline(Solver, double) -> WithDeadline<Solver>;
template <class Solver, Clock C>
WithDeadline(Solver, double, C) -> WithDeadline<Solver, C>;
template <class Solver, Clock C>
WithDeadline(Solver, double, C, double) -> WithDeadline<Solver, C>;

}  // namespace delassus
