/// What a comparison adds up to: every figure as CSV, a line an engine and row, and the table of
/// docs/evidence/ladders.md.
#pragma once

#include "referee.hpp"

#include <delassus/io/table.hpp>

namespace ladders::peers {

/// One row of the ladders by one engine, or by the loop of the row.
struct Climb {
  const Row* row;
  const EngineKind* kind;  ///< null: delassus
  std::vector<Outcome> rungs;

  /// How many rungs in a row, from the first, reach a level.
  std::size_t up_to(Level level) const;
  /// Nothing of it was stepped.
  bool is_refused() const { return rungs.empty() || rungs.front().is_refused; }
  std::string engine() const { return kind ? kind->title : "delassus"; }
};

delassus::Table figures(const std::vector<Climb>& all);
delassus::Table summary(const std::vector<Climb>& all);
/// Rows down, engines across: "silver/gold of rungs, time of a step".
std::string markdown(const std::vector<Climb>& all);

}  // namespace ladders::peers
