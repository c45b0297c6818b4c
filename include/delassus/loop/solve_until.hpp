/// The solve of a problem by itself, until a moment on a clock.
#pragma once

#include <delassus/core/clock.hpp>
#include <delassus/loop/problem.hpp>
#include <delassus/solvers/with_deadline.hpp>

#include <limits>

namespace delassus {

/// Solves from the present λ until the solver's own tolerance holds or `deadline` (s on `clock`) has come; what is left in
/// `problem` is then the iterate of the smallest measured residual. The first island is begun whatever the time is.
template <class Laws, class Rows, class Operator, class Solver, Clock C = SteadyClock>
SolveReport solve_until(Problem<Laws, Rows, Operator>& problem, const Solver& solver, double deadline,
                        SolverWorkspace<Problem<Laws, Rows, Operator>, WithDeadline<Solver, C>>& workspace,
                        C clock = {}) {
  const WithDeadline<Solver, C> timed{solver, std::numeric_limits<double>::infinity(), clock, deadline};
  timed.check();
  return solve(problem, timed, workspace);
}

/// The same with a workspace of its own, which is let go of after the deadline: that takes up to a millisecond where
/// Newton's method has acted on a thousand boxes.
template <class Laws, class Rows, class Operator, class Solver, Clock C = SteadyClock>
SolveReport solve_until(Problem<Laws, Rows, Operator>& problem, const Solver& solver, double deadline, C clock = {}) {
  SolverWorkspace<Problem<Laws, Rows, Operator>, WithDeadline<Solver, C>> workspace;
  return solve_until(problem, solver, deadline, workspace, clock);
}

}  // namespace delassus
