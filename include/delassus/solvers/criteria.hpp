/// When a solve may stop.
#pragma once

#include <delassus/solvers/measure.hpp>

namespace delassus {

/// Stops on the scale-free residual. The default.
struct Residual {
  static constexpr bool needs_measure = true;
  static double sum(const Measure& m) { return m.residual; }
  static double worst(const Measure& m) { return m.worst; }
};

/// Stops on Siconos' measure, for comparison.
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
