/// What a solver says of one island.
#pragma once

#include <delassus/core/index.hpp>
#include <delassus/core/status.hpp>
#include <delassus/solvers/measure.hpp>

namespace delassus {

/// Of one island.
struct SolveReport {
  Status status = Status::converged;  ///< solved, or why not
  int sweeps = 0;  ///< over the whole island
  Measure measure{};  ///< of the impulses that it left
  int factorizations = 0;  ///< of Newton's method, sweeps not counted
  const char* ended_by = "sweeps";  ///< the stage of the solver that came last
  bool are_loads_decided = false;  ///< of the impulses that make the same motion these are chosen by a rule, not by the order of sweeps
  Index undecided_loads = 0;  ///< see `StepReport::undecided_loads`
};

namespace inner {

/// Sweeps between two measurements. With a measurement at the price of c sweeps, one every m sweeps costs n c/m on the way to
/// n sweeps and m/2 sweeps too many at the end: least for m = √(2 c n). c lies between 1 and 2.
inline int patience(int sweeps) {
  return sweeps < 4 ? 1 : sweeps < 8 ? 2 : sweeps < 24 ? 4 : sweeps < 64 ? 8 : sweeps < 512 ? 16 : 32;
}

}  // namespace inner
}  // namespace delassus
