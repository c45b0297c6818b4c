/// Sweeps over items by colour, in an order that several threads can share.
#pragma once

#include <delassus/core/array.hpp>
#include <delassus/core/if_it_has.hpp>
#include <delassus/core/roles.hpp>
#include <delassus/core/wrapping.hpp>
#include <delassus/solvers/inner/colouring.hpp>
#include <delassus/solvers/inner/lane_loops.hpp>
#include <delassus/solvers/inner/pieces.hpp>
#include <delassus/solvers/island.hpp>
#include <delassus/solvers/solve_report.hpp>

#include <type_traits>

namespace delassus {
namespace inner {

template <class T, class Space>
struct ColouredSpace {
  Space solver;
  Colouring<T> colours;
  Pieces<T> pieces;
  std::conditional_t<std::is_same_v<T, double>, PackedContacts, NothingPacked> packed;

  void reset(Index rows) { reset_if_it_can(solver, rows); }
};

}  // namespace inner

/// `Coloured{AcceleratedGaussSeidel{}}` visits the constraints of an island of many by colour: no two of one
/// colour act on the same moving body. So several threads sweep a colour at once (`Threads`), with the same
/// bits as one.
///
/// Contacts of a colour by `Coulomb` in double are swept by as many at a time as the vector unit takes: those
/// of the loop's first such law. A solve copies their rows of W for that. Other laws are visited item by
/// item.
///
/// The sums of a sweep have another order than without it, and so does the sweep: another solution within the
/// tolerance, after more or fewer sweeps. Its bits depend on the vector unit that the program is compiled for
/// (`-march`), not on the number of threads. Small islands, those under a deadline and those of a W without
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
    if (!problem.has_own_passes() && problem.row_count() >= least_rows && !problem.timer() &&
        work.colours.make(problem.begin(), problem.end())) {
      Array<Span<T>>& spans = work.colours.spans();
      work.packed.take(spans);
      problem.pass_by(spans.data(), int(spans.size()), work.pieces);
    }
    if (!problem.has_own_passes()) return solver.solve(problem, work.solver);
    work.packed.fill(problem.crew());
    const SolveReport report = solver.solve(problem, work.solver);
    work.packed.give_back();
    return report;
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
