/// The constraint problem of a step as a thing of its own.
#pragma once

#include <delassus/rows/islands.hpp>
#include <delassus/solvers/island_problem.hpp>
#include <delassus/solvers/law_book.hpp>
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
  Islands<Laws::pool_count> islands;
  double h = 0;  ///< s
};

/// Solves a problem from its present λ with any solver; the report is the worst of the islands'.
template <class Laws, class Rows, class Operator, class Solver>
SolveReport solve(Problem<Laws, Rows, Operator>& problem, const Solver& solver) {
  LawBook<Laws, typename Rows::Scalar> book(problem.laws);
  typename Solver::template Workspace<Rows> workspace;
  if constexpr (requires { workspace.reset(problem.rows); }) workspace.reset(problem.rows);
  problem.W.reset(problem.rows);
  book.prepare(problem.W, problem.rows, problem.h);
  NoObserver nobody;
  SolveReport worst;
  for (Index k = 0; k < problem.islands.count(); ++k) {
    IslandProblem island(book, problem.rows, problem.W, problem.islands, k, problem.h, nobody);
    const SolveReport r = solver.solve(island, workspace);
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

}  // namespace delassus
