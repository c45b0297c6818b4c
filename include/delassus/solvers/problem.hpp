/// The constraint problem of a step as a thing of its own.
#pragma once

#include <delassus/core/if_it_has.hpp>
#include <delassus/rows/islands.hpp>
#include <delassus/solvers/island_problem.hpp>
#include <delassus/solvers/law_set.hpp>
#include <delassus/solvers/solve_report.hpp>

#include <vector>

namespace delassus {

/// Typed copies of the items (`laws`), the rows with H, φ, d and λ, the operator W, and the islands.
template <class Laws, class Rows_, class Operator>
struct Problem {
  using Rows = Rows_;
  Laws laws;
  Rows rows;
  Operator W;
  Islands<typename Rows::Scalar> islands;
  double h = 0;  ///< s
};

/// What `solve` keeps of problems of one type for the next of them.
template <class Problem, class Solver>
struct SolverWorkspace {
  LawSet<decltype(Problem::laws), typename Problem::Rows::Scalar, inner::needs_of<Solver>> book;
  typename Solver::template Workspace<typename Problem::Rows> solver;
};

/// Solves a problem from the λ in it, with any solver, and leaves the new λ there; the report is the worst of the
/// islands'. A problem no larger than `workspace` has seen is solved without an allocation.
template <class Laws, class Rows, class Operator, class Solver>
SolveReport solve(Problem<Laws, Rows, Operator>& problem, const Solver& solver,
                  SolverWorkspace<Problem<Laws, Rows, Operator>, Solver>& workspace) {
  auto& book = workspace.book;
  book.attach(problem.laws);
  inner::begin_step_if_it_can(workspace.solver);
  inner::reset_if_it_can(workspace.solver, problem.rows.row_count());
  problem.W.reset(problem.rows);
  book.prepare(problem.W, problem.rows, problem.h);
  NoObserver nobody;
  SolveReport worst;
  for (Index k = 0; k < problem.islands.count(); ++k) {
    IslandProblem island(book, problem.rows, problem.W, problem.islands, k, problem.h, nobody);
    const SolveReport r = solver.solve(island, workspace.solver);
    worst.status = worse(worst.status, r.status);
    worst.sweeps = std::max(worst.sweeps, r.sweeps);
    worst.factorizations = std::max(worst.factorizations, r.factorizations);
    if (!(r.measure.residual < worst.measure.residual)) {  // NaN is the worst of all
      worst.measure = r.measure;
      worst.ended_by = r.ended_by;
    }
  }
  return worst;
}

/// The same with a workspace of its own.
template <class Laws, class Rows, class Operator, class Solver>
SolveReport solve(Problem<Laws, Rows, Operator>& problem, const Solver& solver) {
  SolverWorkspace<Problem<Laws, Rows, Operator>, Solver> workspace;
  return solve(problem, solver, workspace);
}

}  // namespace delassus
