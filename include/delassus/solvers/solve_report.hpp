/// What a solver says of one island.
#pragma once

#include <delassus/core/cmath.hpp>
#include <delassus/core/status.hpp>
#include <delassus/solvers/measure.hpp>

#include <algorithm>

namespace delassus {

struct SolveReport {
  Status status = Status::converged;
  int sweeps = 0;
  Measure measure{};
  int factorizations = 0;  ///< of Newton's method, sweeps not counted
  const char* ended_by = "sweeps";  ///< the stage of the solver that came last
};

namespace inner {

/// How far a part of a solver may go.
struct SolveLimits {
  double tolerance = 1e-6;
  int max_iterations = 0, min_iterations = 0;
  bool scale_tolerance = false, all_verified = false;
};

/// tolerance, times the number of rows when `scale_tolerance` asks; or every constraint's share when `all_verified`.
template <class Criterion, class Solver>
bool is_within(const Solver& solver, const Measure& m, int rows) {
  if (solver.all_verified) return Criterion::worst(m) <= solver.tolerance;
  return Criterion::sum(m) <= solver.tolerance * (solver.scale_tolerance ? rows : 1);
}

/// Within it, or at the floor of rounding by what was measured.
template <class Criterion, class Solver>
bool is_done(const Solver& solver, const Measure& m, int rows) {
  return is_within<Criterion>(solver, m, rows) || m.residual <= m.floor;
}

/// Sweeps between two measurements. With a measurement at the price of c sweeps, one every m sweeps costs n c/m on the way to
/// n sweeps and m/2 sweeps too many at the end: least for m = √(2 c n). c lies between 1 and 2.
inline int patience(int sweeps) {
  return sweeps < 4 ? 1 : sweeps < 8 ? 2 : sweeps < 24 ? 4 : sweeps < 64 ? 8 : sweeps < 512 ? 16 : 32;
}

/// Converged, at the rounding floor above the tolerance, out of sweeps, or away to where there are no numbers.
template <class Criterion, class Solver>
Status verdict(const Solver& solver, const Measure& m, int rows) {
  if (is_within<Criterion>(solver, m, rows)) return Status::converged;
  if (!std::isfinite(m.residual)) return Status::quarantined;
  return m.residual <= m.floor ? Status::stalled : Status::max_iterations;
}

}  // namespace inner
}  // namespace delassus
