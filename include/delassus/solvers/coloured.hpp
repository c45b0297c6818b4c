/// Sweeps over items by colour, in an order that several threads can share.
#pragma once

#include <delassus/core/array.hpp>
#include <delassus/core/if_it_has.hpp>
#include <delassus/core/roles.hpp>
#include <delassus/core/wrapping.hpp>
#include <delassus/solvers/inner/colouring.hpp>
#include <delassus/solvers/inner/pieces.hpp>
#include <delassus/solvers/island.hpp>
#include <delassus/solvers/solve_report.hpp>

#include <cstddef>

namespace delassus {
namespace inner {

template <class T, class Space>
struct ColouredSpace {
  Space solver;
  Colouring<T> colours;
  Pieces<T> pieces;

  void reset(Index rows) { reset_if_it_can(solver, rows); }
};

}  // namespace inner

/// `Coloured{AcceleratedGaussSeidel{}}` visits the constraints of an island of many by colour: no two of one
/// colour act on the same moving body. So several threads sweep a colour at once (`Threads`), with the same
/// bits as one.
///
/// The sums of a sweep have another order than without it, and so does the sweep: another solution within the
/// tolerance, after more or fewer sweeps. Small islands, those under a deadline and those of a W without
/// blocks (`MatrixFreeCompliance`) are swept in their own order.
template <class Solver = inner::Absent>
struct Coloured {
  using plays = role::Solver;
  static constexpr unsigned layers = inner::layers_of<Solver> | inner::layer::coloured;
  Solver solver{};       ///< sweeps
  int least_rows = 192;  ///< of an island that is coloured

  static constexpr Needs needs = inner::needs_of<Solver>;
  template <class Rows>
  using Workspace = inner::ColouredSpace<typename Rows::Scalar, typename Solver::template Workspace<Rows>>;

  void check() const { solver.check(); }

  template <class T, class Space>
  SolveReport solve(Island<T>& problem, Space& work) const {
    // An island may be solved again, after bounces were taken away.
    if (problem.row_count() >= least_rows && !problem.timer() && !problem.has_own_passes() &&
        work.colours.make(problem.begin(), problem.end()))
      problem.pass_by(work.colours.spans().data(), int(work.colours.spans().size()), work.pieces);
    return solver.solve(problem, work.solver);
  }
};

/// Around what is no solver, or another one; the loop's checks say so.
template <class Solver>
requires(!inner::Fills<Solver, role::Solver, inner::layer::coloured>) struct Coloured<Solver>
    : inner::Hollow {
  using plays = role::Solver;
  using inner::Hollow::Hollow;
};

/// `Coloured{solver}`.
template <class Solver>
Coloured(Solver) -> Coloured<Solver>;

}  // namespace delassus
