/// When a solve may stop: the number that is compared with the solver's tolerance. `sum` is the island's, `worst` the largest share
/// of one constraint, which a solver with `all_verified` compares.
#pragma once

#include <delassus/solvers/measure.hpp>

namespace delassus {

/// Stops on the scale-free residual. The default.
struct Residual {
  static constexpr bool needs_measure = true;
  static double sum(const Measure& m) { return m.residual; }
  static double worst(const Measure& m) { return m.worst; }
};

/// Stops on Siconos' measure, for comparison. It has no shares: `all_verified` compares the island's, which is stricter.
struct SiconosError {
  static constexpr bool needs_measure = true;
  static double sum(const Measure& m) { return m.siconos; }
  static double worst(const Measure& m) { return m.siconos; }
};

/// Stops on the change of the last sweep, expressed as displacement (m): cheap, and blind to slow convergence.
struct LastChange {
  static constexpr bool needs_measure = false;
  static double sum(const Measure& m) { return m.last_change; }
  static double worst(const Measure& m) { return m.worst_change; }
};

}  // namespace delassus
