// The tables of a comparison.
#include "tables.hpp"

#include "../peer_figures.hpp"

#include <delassus/io/inner/text.hpp>

#include <algorithm>
#include <tuple>

namespace ladders::peers {

namespace {

using delassus::Cell, delassus::Table;
using delassus::inner::number_text;

bool is_same_case(const Row& a, const Row& b) {
  return std::string_view(a.id) == b.id && std::string_view(a.title) == b.title;
}

/// What stopped a rung, or the figure that keeps it from silver, or from gold.
std::string shortfall(const Outcome& rung) {
  if (!rung.said.empty()) return rung.said;
  const Outcome::Figure* worst = nullptr;
  for (const auto& f : rung.figures)
    if (f.level < Level::gold && (!worst || f.level < worst->level)) worst = &f;
  if (!worst) return "";
  const bool is_silver = worst->level == Level::silver;
  return worst->what + " " + number_text(worst->value, 3) + " (" + (is_silver ? "gold" : "silver") + " ≤ " +
         number_text(is_silver ? worst->gold : worst->silver, 3) + ")";
}

/// The first rung below silver, or below gold where all are silver.
std::string first_short(const Climb& climb) {
  for (const Level level : {Level::silver, Level::gold})
    if (const std::size_t k = climb.up_to(level); k < climb.rungs.size())
      return climb.rungs[k].difficulty + ": " + name(climb.rungs[k].level) + ", " + shortfall(climb.rungs[k]);
  return "";
}

/// The most rungs that anybody saw of a case: a row ends where its engine fails.
std::size_t rungs_of(const std::vector<Climb>& all, const Row& row) {
  std::size_t most = 0;
  for (const Climb& climb : all)
    if (is_same_case(*climb.row, row)) most = std::max(most, climb.rungs.size());
  return most;
}

bool is_better(const Climb& a, const Climb& b) {
  const auto rank = [](const Climb& c) {
    return std::tuple(c.up_to(Level::silver), c.up_to(Level::gold), c.up_to(Level::bronze));
  };
  if (rank(a) != rank(b)) return rank(a) > rank(b);
  return a.rungs.front().microseconds < b.rungs.front().microseconds;
}

std::string cell(const Climb* climb, std::size_t rungs) {
  if (!climb) return "";
  if (climb->is_refused()) return "–";
  return std::to_string(climb->up_to(Level::silver)) + "/" + std::to_string(climb->up_to(Level::gold)) +
         " of " + std::to_string(rungs) + ", " + time_text(climb->rungs.front().microseconds);
}

}  // namespace

std::size_t Climb::up_to(Level level) const {
  std::size_t count = 0;
  while (count < rungs.size() && rungs[count].level >= level) ++count;
  return count;
}

Table figures(const std::vector<Climb>& all) {
  Table table{.columns = {"case", "title", "engine", "parts", "rung", "rung_level", "figure", "value",
                          "silver", "gold", "level", "microseconds"}};
  for (const Climb& climb : all)
    for (const Outcome& rung : climb.rungs) {
      const auto add = [&](const std::string& what, const Cell& value, const Cell& silver, const Cell& gold,
                           Level level) {
        table.add({climb.row->id, climb.row->title, climb.engine(),
                   climb.kind ? climb.kind->settings : climb.row->parts, rung.difficulty, name(rung.level),
                   what, value, silver, gold, name(level), Cell(rung.microseconds, 4)});
      };
      for (const auto& f : rung.figures)
        add(f.what, Cell(f.value, 6), Cell(f.silver, 4), Cell(f.gold, 4), f.level);
      if (!rung.said.empty()) add(rung.said, "", "", "", Level::failed);
    }
  return table;
}

Table summary(const std::vector<Climb>& all) {
  Table table{.columns = {"case", "title", "engine", "parts", "rungs", "bronze", "silver", "gold", "short",
                          "microseconds"}};
  for (const Climb& climb : all) {
    const bool is_out = climb.is_refused();
    const auto count = [&](Level level) { return is_out ? Cell("") : Cell(climb.up_to(level)); };
    table.add({climb.row->id, climb.row->title, climb.engine(), climb.kind ? "" : climb.row->parts,
               Cell(rungs_of(all, *climb.row)), count(Level::bronze), count(Level::silver),
               count(Level::gold),
               is_out ? (climb.rungs.empty() ? "not run" : climb.rungs.front().said) : first_short(climb),
               is_out ? Cell("") : Cell(climb.rungs.front().microseconds, 3)});
  }
  return table;
}

std::string markdown(const std::vector<Climb>& all) {
  std::vector<const EngineKind*> kinds;
  std::vector<const Row*> cases;
  for (const Climb& climb : all) {
    if (climb.kind && std::find(kinds.begin(), kinds.end(), climb.kind) == kinds.end())
      kinds.push_back(climb.kind);
    if (std::none_of(cases.begin(), cases.end(), [&](const Row* r) { return is_same_case(*r, *climb.row); }))
      cases.push_back(climb.row);
  }
  std::string out = "| case | delassus, its best parts |", rule = "| --- | --- |", left;
  for (const EngineKind* kind : kinds) out += std::string(" ") + kind->title + " |", rule += " --- |";
  out += "\n" + rule + "\n";
  for (const Row* row : cases) {
    const Climb* ours = nullptr;
    bool is_compared = false;
    std::string reason, others;
    for (const Climb& climb : all)
      if (is_same_case(*climb.row, *row)) {
        if (!climb.kind && !climb.is_refused() && (!ours || is_better(climb, *ours))) ours = &climb;
        if (climb.kind && !climb.is_refused()) is_compared = true;
        if (climb.is_refused() && !climb.rungs.empty()) reason = climb.rungs.front().said;
      }
    if (!is_compared) {
      left += std::string(left.empty() ? "" : "; ") + row->id + " " + row->title + ": " + reason;
      continue;
    }
    const std::size_t rungs = rungs_of(all, *row);
    for (const EngineKind* kind : kinds) {
      const auto found = std::find_if(all.begin(), all.end(), [&](const Climb& c) {
        return c.kind == kind && is_same_case(*c.row, *row);
      });
      others.append(" ").append(cell(found == all.end() ? nullptr : &*found, rungs)).append(" |");
    }
    out += std::string("| ") + row->id + " " + row->title + " | " + cell(ours, rungs) +
           (ours && *ours->row->parts ? std::string(" (") + ours->row->parts + ")" : "") + " |" + others +
           "\n";
  }
  if (!left.empty()) out.append("\nNot compared: ").append(left).append(".\n");
  return out;
}

}  // namespace ladders::peers
