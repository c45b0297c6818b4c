/// What the rungs of all rows add up to: a table on the terminal, a CSV, a page, and the table of
/// docs/evidence/ladders.md.
#pragma once

#include "peer_figures.hpp"
#include "rows.hpp"

#include <delassus/io/table.hpp>

#include <string>
#include <vector>

namespace ladders {

struct Climbed {
  const Row* row;
  std::vector<Rung> rungs;

  /// How many rungs in a row, from the first, reach a level.
  std::size_t up_to(Level level) const {
    std::size_t count = 0;
    while (count < rungs.size() && rungs[count].level >= level) ++count;
    return count;
  }
};

/// One row a ladder: the last rung before the first that falls short, for each level, and the figure of that
/// one.
delassus::Table summary(const std::vector<Climbed>& all);
/// One row a figure, with every rung.
delassus::Table figures(const std::vector<Climbed>& all);
/// The summary and what is missing, as Markdown, the best of other engines beside each row.
std::string markdown(const std::vector<Climbed>& all, const std::vector<PeerFigure>& peers);
/// A page that needs nothing else: a square a rung, its figures where the pointer rests.
std::string page(const std::vector<Climbed>& all, const std::vector<PeerFigure>& peers);

}  // namespace ladders
