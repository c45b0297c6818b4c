/// What an ensemble found, as a table.
#pragma once

#include <delassus/io/inner/text.hpp>
#include <delassus/io/table.hpp>
#include <delassus/study/ensemble_results.hpp>
#include <delassus/study/inner/run_log.hpp>

#include <algorithm>
#include <cstddef>
#include <string>
#include <utility>
#include <vector>

namespace delassus {

/// A line for each row of each run: its number, its parameters, the time (s), what was observed, steps that did not converge, and why it
/// failed. A run that failed before its first row has a line with its time alone. Numbers have so many significant digits, from 17 on all.
inline Table runs_table(const EnsembleResults& results, int digits = 17) {
  const EnsemblePlan& plan = results.plan;
  Table table{.title = plan.name, .columns = {"run", "parameters", "time (s)"}};
  table.columns.insert(table.columns.end(), plan.observations.begin(), plan.observations.end());
  table.columns.push_back("steps not converged");
  table.columns.push_back("failure");
  for (const EnsembleRun& run : results.runs)
    for (std::size_t r = 0; r < std::max<std::size_t>(run.rows(), 1); ++r) {
      const auto number = inner::number_in(run.parameters);
      const double time = r < run.rows() ? plan.time(r) : double(run.steps) * plan.h;
      std::vector<Cell> cells{run.number, number ? Cell(*number, digits) : Cell(run.parameters), Cell(time, digits)};
      for (std::size_t k = 0; k < plan.observations.size(); ++k)
        cells.push_back(r < run.rows() ? Cell(run.row(r)[k], digits) : Cell(""));
      cells.push_back(run.capped_steps);
      cells.push_back(run.failure);
      table.add(std::move(cells));
    }
  return table;
}

}  // namespace delassus
