/// What a study found, as tables.
#pragma once

#include <delassus/io/csv.hpp>
#include <delassus/io/table.hpp>
#include <delassus/study/study.hpp>

#include <array>
#include <cstddef>
#include <string>
#include <utility>
#include <vector>

namespace delassus {

namespace inner {

inline std::vector<Cell> cells_of(const Study& study, const StudyRun& run, int digits) {
  std::vector<Cell> row{run.code, run.is_controlled() ? Cell("accuracy " + number_text(run.accuracy, 6)) : Cell(run.h, 6)};
  for (const double e : run.errors) row.push_back(Cell(e, digits));
  row.push_back(Cell(1e3 * run.cost / study.plan.duration, digits));
  row.push_back(Cell(run.steps > 0 ? run.sweeps / double(run.steps) : 0, digits));
  row.push_back(run.capped_steps > 0
                    ? std::to_string(run.capped_steps) + " of " + std::to_string(run.steps) + " steps"
                    : std::string(name(run.outcome)));
  return row;
}

inline std::vector<std::string> columns_of(const Study& study) {
  std::vector<std::string> columns{"policies", "step (s)"};
  for (const StudyMeasure& m : study.measures) columns.push_back(m.name + " (" + m.unit + ")");
  for (const char* name : {"time per simulated second (ms)", "sweeps a step", "outcome"})
    columns.push_back(name);
  return columns;
}

}  // namespace inner

/// The runs that no other beats in both cost and error of measure m, cheapest first.
inline Table front_table(const Study& study, int m = 0) {
  Table table{
      .title = study.plan.name + ": the best for their cost, by " + study.measures[std::size_t(m)].name,
      .columns = inner::columns_of(study)};
  for (const StudyRun* run : study.front(m)) table.add(inner::cells_of(study, *run, 3));
  std::array<int, 4> outcomes{};
  for (const StudyRun& run : study.runs) ++outcomes[std::size_t(run.outcome)];
  table.caption = std::to_string(study.runs.size()) + " runs:";
  for (std::size_t k = 0; k < outcomes.size(); ++k)
    if (outcomes[k] > 0) table.caption += " " + std::to_string(outcomes[k]) + " " + name(Outcome(k)) + ",";
  table.caption.back() = '.';
  for (const StudyMeasure& measure : study.measures)
    if (measure.uncertainty > 0)
      table.caption += " The reference of " + measure.name + " is sure to " +
                       inner::number_text(measure.uncertainty, 2) + " " + measure.unit + ".";
  return table;
}

/// Combinations of which a run failed, was too slow or did not converge: how many of how many.
inline Table trouble_table(const Study& study) {
  Table table{.title = study.plan.name + ": what did not work",
              .columns = {"policies", "failed", "too slow", "not converged", "runs"}};
  for (int c = 0; c < study.combinations; ++c) {
    std::array<int, 4> outcomes{};
    int runs = 0;
    std::string policies;
    const auto at = study.choices(c);
    for (std::size_t a = 0; a < at.size(); ++a)
      policies += (a > 0 ? ", " : "") + study.axes[a][std::size_t(at[a])];
    for (const StudyRun& run : study.runs)
      if (run.combination == c) ++outcomes[std::size_t(run.outcome)], ++runs;
    if (outcomes[1] + outcomes[2] + outcomes[3] > 0)
      table.add({policies, outcomes[2], outcomes[3], outcomes[1], runs});
  }
  return table;
}

/// Every run with every digit: for CSV. The uncertainty of each reference stands in its column's own one.
inline Table runs_table(const Study& study) {
  Table table{.title = study.plan.name,
              .columns = {"run", "combination", "policies", "tolerance", "h (s)", "outcome", "cost (s)",
                          "least cost (s)", "steps", "sweeps", "steps not converged", "accuracy", "inner steps", "repeated"}};
  for (const StudyMeasure& m : study.measures) {
    table.columns.push_back(m.name + " (" + m.unit + ")");
    table.columns.push_back(m.name + ", uncertainty (" + m.unit + ")");
  }
  for (const StudyRun& run : study.runs) {
    std::vector<Cell> row{run.number,        run.combination,
                          run.code,          run.tolerance >= 0 ? Cell(run.tolerance, 17) : Cell(""),
                          Cell(run.h, 17),   name(run.outcome),
                          Cell(run.cost, 9), Cell(run.least_cost, 9),
                          run.steps,         Cell(run.sweeps, 17),
                          run.capped_steps,
                          run.is_controlled() ? Cell(run.accuracy, 17) : Cell(""),
                          run.inner_steps,
                          run.repeated};
    for (std::size_t k = 0; k < run.errors.size(); ++k) {
      row.push_back(Cell(run.errors[k], 17));
      row.push_back(Cell(study.measures[k].uncertainty, 17));
    }
    table.add(std::move(row));
  }
  return table;
}

}  // namespace delassus
