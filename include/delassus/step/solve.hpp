/// Solve: island by island, each with its own stopping test and status.
#pragma once

#include <delassus/core/slice.hpp>
#include <delassus/solvers/solve_report.hpp>
#include <delassus/step/step_report.hpp>

#include <algorithm>

namespace delassus {

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
