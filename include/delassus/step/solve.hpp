/// Solve: island by island, each with its own stopping test and status.
#pragma once

#include <delassus/core/slice.hpp>
#include <delassus/rows/islands.hpp>
#include <delassus/solvers/island_problem.hpp>
#include <delassus/solvers/solve_report.hpp>
#include <delassus/step/step_report.hpp>

#include <algorithm>

namespace delassus {

/// Solves one island.
template <class Book, class Rows, class Operator, int pools, class Solver, class Workspace, class Observer>
SolveReport solve_island(Book& book, Rows& rows, Operator& W, const Islands<pools>& islands, Index island,
                         const Solver& solver, Workspace& workspace, double h, Observer& observer) {
  IslandProblem<Book, Rows, Operator, Observer> problem(book, rows, W, islands, island, h, observer);
  return solver.solve(problem, workspace);
}

/// The worst of the islands.
inline void summarise(inner::Slice<const SolveReport> islands, StepReport& step) {
  for (const SolveReport& r : islands) {
    step.status = worse(step.status, r.status);
    step.sweeps = std::max(step.sweeps, r.sweeps);
    step.residual = std::max(step.residual, r.measure.residual);
    step.natural_map_error = std::max(step.natural_map_error, r.measure.siconos);
  }
}

}  // namespace delassus
