/// The solve of a problem by itself, until a moment on a clock.
#pragma once

#include <delassus/core/clock.hpp>
#include <delassus/core/roles.hpp>
#include <delassus/core/wrapping.hpp>
#include <delassus/solvers/problem.hpp>
#include <delassus/solvers/with_deadline.hpp>

#include <concepts>
#include <limits>

namespace delassus {

namespace inner {

template <class Solver>
consteval bool takes_deadline() {
  constexpr bool takes = Fills<Solver, role::Solver, layer::deadline>;
  static_assert(takes,
                "delassus: solve_until(problem, solver, deadline) makes the deadline itself, around a solver without "
                "one; of a WithDeadline pass its member `solver`");
  return takes;
}

}  // namespace inner

/// Solves from the λ in `problem` until the solver's own tolerance holds or `deadline` (s on `clock`) has come. What is left
/// there is then the iterate of the smallest measured residual. The first λ is one of them where the solver's
/// `min_iterations` is 0. The first island is begun whatever the time is. As from step to step in a loop, what came to
/// nothing before a deadline is passed over in the next solves with the same workspace, up to sixteen times.
template <class Laws, class Rows, class Operator, class Solver, Clock C = SteadyClock>
SolveReport solve_until(Problem<Laws, Rows, Operator>& problem, const Solver& solver, double deadline,
                        SolverWorkspace<Problem<Laws, Rows, Operator>, WithDeadline<Solver, C>>& workspace,
                        C clock = {}) {
  if constexpr (inner::takes_deadline<Solver>()) {
    const WithDeadline<Solver, C> timed{solver, std::numeric_limits<double>::infinity(), clock, deadline};
    timed.check();
    return solve(problem, timed, workspace);
  } else {
    return {};
  }
}

/// The same with a workspace of its own, which is let go of after the deadline: that takes time where
/// Newton's method has acted on many bodies.
template <class Laws, class Rows, class Operator, class Solver, Clock C = SteadyClock>
SolveReport solve_until(Problem<Laws, Rows, Operator>& problem, const Solver& solver, double deadline, C clock = {}) {
  if constexpr (inner::takes_deadline<Solver>()) {
    SolverWorkspace<Problem<Laws, Rows, Operator>, WithDeadline<Solver, C>> workspace;
    return solve_until(problem, solver, deadline, workspace, clock);
  } else {
    return {};
  }
}

/// With the workspace of another solver: one sentence says of which it should be.
template <class Laws, class Rows, class Operator, class Solver, class Other, Clock C = SteadyClock>
  requires(!std::same_as<Other, WithDeadline<Solver, C>>)
SolveReport solve_until(Problem<Laws, Rows, Operator>&, const Solver&, double,
                        SolverWorkspace<Problem<Laws, Rows, Operator>, Other>&, C = {}) {
  if constexpr (inner::takes_deadline<Solver>())
    static_assert(std::same_as<Other, WithDeadline<Solver, C>>,
                  "delassus: solve_until takes the workspace of the solver in its deadline: "
                  "SolverWorkspace<decltype(problem), WithDeadline<AcceleratedGaussSeidel>> for an AcceleratedGaussSeidel");
  return {};
}

}  // namespace delassus
