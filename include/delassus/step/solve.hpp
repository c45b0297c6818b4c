/// Solve: island by island, each with its own stopping test and status.
#pragma once

#include <delassus/core/slice.hpp>
#include <delassus/fwd.hpp>
#include <delassus/rows/row_kind.hpp>
#include <delassus/solvers/island.hpp>
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
    step.undecided_loads += r.undecided_loads;
  }
}

namespace inner {

/// Whether a law's first row can only push, as that of a contact.
template <class Laws>
inline constexpr bool some_push = false;
template <class... L>
inline constexpr bool some_push<Constraints<L...>> = ((row_kinds<L>()[0] == RowKind::lower) || ...);

/// Of an island whose solver says whether it decided the loads.
template <class T>
Index undecided_loads(const Island<T>& island, const SolveReport& report) {
  if (report.are_loads_decided) return 0;
  Index pushing = 0;
  for (const Span<T>& span : island) {
    if (span.pool->table->kinds[0] != RowKind::lower) continue;
    for (const Index i : span) pushing += island.impulse(span, i)[0] > 0 ? 1 : 0;
  }
  return pushing < 3 ? 0 : pushing;
}

}  // namespace inner

}  // namespace delassus
