/// Gauss-Seidel sweeps over an island, written once: no law, no row count, no body in sight.
#pragma once

#include "island.hpp"

#include <delassus/solvers/criteria.hpp>
#include <delassus/solvers/solve_report.hpp>

namespace light {

/// As `delassus::GaussSeidel`; the best measured impulses are given back when the time is up.
struct GaussSeidel {
  double tolerance = 1e-6;
  int max_iterations = 1000, min_iterations = 1;
  double relaxation = 1;
  bool scale_tolerance = false, all_verified = false;

  template <class T>
  SolveReport solve(Island<T>& island) const;

 private:
  bool is_done(const Measure& m, int rows) const {
    return inner::is_within<Residual>(*this, m, rows) || m.residual <= m.floor;
  }
};

template <class T>
SolveReport GaussSeidel::solve(Island<T>& island) const {
  const SolveControl& control = island.control();
  const int rows = island.row_count();
  SolveReport report{.measure = island.measure()};
  control.notify(0, report.measure);
  if (!std::isfinite(report.measure.residual))
    return {.status = Status::quarantined, .measure = report.measure};
  Array<T> best;
  Measure least = report.measure;
  const auto keep = [&] {
    if (control.has_deadline() && !(report.measure.residual > least.residual))
      island.save(best), least = report.measure;
  };
  keep();
  while (report.sweeps < max_iterations &&
         (report.sweeps < min_iterations || !is_done(report.measure, rows))) {
    const int batch =
        control.observe ? 1 : std::min(inner::patience(report.sweeps), max_iterations - report.sweeps);
    for (int k = 0; k < batch && !island.is_cut(); ++k) {
      island.sweep(T(relaxation), report.sweeps >= min_iterations);
      report.sweeps += !island.is_cut();
    }
    if (island.is_cut()) {
      island.load(best);
      return {.status = Status::deadline, .sweeps = report.sweeps, .measure = least};
    }
    report.measure = island.measure();
    control.notify(report.sweeps, report.measure);
    keep();
  }
  report.status = inner::verdict<Residual>(*this, report.measure, rows);
  return report;
}

}  // namespace light
