/// When a solve may stop.
#pragma once

#include <delassus/core/cmath.hpp>
#include <delassus/core/expect.hpp>
#include <delassus/core/status.hpp>
#include <delassus/solvers/measure.hpp>

#include <string>

namespace delassus {

/// What a solver's tolerance is compared with. Whatever it is, what goes on into a contact or a limit is compared with it too.
enum class Criterion : unsigned char {
  residual,       ///< the residual, free of scale
  siconos_error,  ///< Siconos' measure or `closing`, for comparison. It has no shares: `all_verified` compares the island's, which is stricter
  both_errors,    ///< the larger of these two
  last_change,    ///< the change of the last sweep as displacement or `sinking`, m: cheap, and blind to slow convergence
};

/// The numbers that all solvers have, whose meanings and defaults are theirs.
struct SolveOptions {
  double tolerance = 1e-6;  ///< of the criterion
  /// Of sweeps or factorizations, as the solver says.
  int max_iterations = 0, min_iterations = 0;  ///< even where the start is good enough
  bool scale_tolerance = false;  ///< tolerance × number of rows
  bool all_verified = false;     ///< every constraint's share below the tolerance, not the sum
  Criterion criterion = Criterion::residual;  ///< what is compared with the tolerance

  /// Whether the criterion needs a measure of all rows.
  bool is_measured() const { return criterion != Criterion::last_change; }
  /// What is compared with the tolerance of an island.
  double error(const Measure& m) const {
    return error(m.residual, m, m.last_change);
  }
  /// The largest share of one constraint.
  double worst_error(const Measure& m) const {
    return error(m.worst, m, m.worst_change);
  }

  /// Whether an island of so many rows is solved, by the tolerance alone.
  bool is_within(const Measure& m, int rows) const {
    if (all_verified) return worst_error(m) <= tolerance;
    return error(m) <= tolerance * (scale_tolerance ? rows : 1);
  }
  /// Within it, or at the floor of rounding by what was measured.
  bool is_done(const Measure& m, int rows) const { return is_within(m, rows) || m.is_at_floor(); }

  /// Converged, at the rounding floor above the tolerance, out of sweeps, or away to where there are no numbers.
  Status verdict(const Measure& m, int rows) const {
    if (is_within(m, rows)) return Status::converged;
    if (!std::isfinite(m.residual)) return Status::quarantined;
    return m.is_at_floor() ? Status::stalled : Status::max_iterations;
  }

 private:
  double error(double residual, const Measure& m, double change) const {
    switch (criterion) {
      case Criterion::residual: return residual;
      case Criterion::siconos_error: return m.closing > m.siconos ? m.closing : m.siconos;
      case Criterion::both_errors: return m.siconos > residual ? m.siconos : residual;
      default: return m.sinking > change ? m.sinking : change;
    }
  }
};

namespace inner {

/// Of a solver that has no sweeps whose change it could ask for.
template <class T = std::string>
void expect_measured(const char* solver, Criterion criterion) {
  DELASSUS_EXPECT(criterion != Criterion::last_change,
                  T(solver) + ": criterion last_change is none of this solver, which stops on a measured error; use residual, siconos_error or both_errors");
}

}  // namespace inner
}  // namespace delassus
