// The tables and the page of delassus_ladders.
#include "report.hpp"

#include <delassus/io/inner/text.hpp>

namespace ladders {

namespace {

using delassus::Cell, delassus::Table;
using delassus::inner::html, delassus::inner::number_text;

/// "all 8", the last rung that is reached, or "none".
std::string reached(const Climbed& ladder, Level level) {
  const std::size_t count = ladder.up_to(level);
  if (count == 0) return "none";
  if (count == ladder.rungs.size()) return "all " + std::to_string(count);
  return std::to_string(count) + " of " + std::to_string(ladder.rungs.size()) + ": " +
         ladder.rungs[count - 1].difficulty;
}

/// The figure that keeps a rung from gold, beside what gold or silver allows.
std::string shortfall(const Rung& rung) {
  if (!rung.trouble.empty()) return rung.trouble;
  const Mark* mark = worst(rung);
  if (!mark) return "";
  const bool is_silver = mark->level() == Level::silver;
  return std::string(mark->what) + " " + number_text(mark->value, 3) + " (" +
         (is_silver ? "gold" : "silver") + " ≤ " + number_text(is_silver ? mark->gold : mark->silver, 3) +
         ")";
}

/// The first rung below silver, or, where all are silver, the first below gold.
std::string first_failing(const Climbed& ladder) {
  for (const Level level : {Level::silver, Level::gold}) {
    const std::size_t count = ladder.up_to(level);
    if (count < ladder.rungs.size())
      return ladder.rungs[count].difficulty + ": " + name(ladder.rungs[count].level) + ", " +
             shortfall(ladder.rungs[count]);
  }
  return "–";
}

std::string all_figures(const Rung& rung) {
  std::string out = rung.difficulty + ": " + name(rung.level);
  for (const Mark& mark : rung.marks)
    out += "\n" + std::string(mark.what) + " " + number_text(mark.value, 3) + " " + name(mark.level());
  return rung.trouble.empty() ? out : out + "\n" + rung.trouble;
}

constexpr const char* style =
    "body{font:15px system-ui,sans-serif;margin:2em auto;max-width:70em;padding:0 "
    "1em;color:#1f2328;background:#fff}"
    "td{padding:.25em .8em .25em 0;vertical-align:top;border-top:1px solid #e3e7eb}small{color:#59636e}"
    ".r{display:inline-block;width:1.1em;height:1.1em;margin-right:3px;border-radius:3px;border:1px solid "
    "#0003}"
    ".gold{background:#e6b422}.silver{background:#b8bec6}.bronze{background:#b06a3b}.failed{background:#fff;"
    "border:2px solid #c22}"
    "@media(prefers-color-scheme:dark){body{color:#e6e6e6;background:#16181c}td{border-color:#333}.failed{"
    "background:#16181c}}";

}  // namespace

Table summary(const std::vector<Climbed>& all) {
  Table table{.columns = {"case", "parts", "bronze", "silver", "gold", "first rung that falls short"}};
  for (const Climbed& ladder : all)
    table.add({std::string(ladder.row->id) + " " + ladder.row->title, ladder.row->parts,
               reached(ladder, Level::bronze), reached(ladder, Level::silver), reached(ladder, Level::gold),
               first_failing(ladder)});
  return table;
}

Table figures(const std::vector<Climbed>& all) {
  Table table{
      .columns = {"case", "title", "parts", "rung", "rung_level", "figure", "value", "level", "seconds"}};
  for (const Climbed& ladder : all)
    for (const Rung& rung : ladder.rungs) {
      const auto add = [&](const std::string& what, const Cell& value, Level level) {
        table.add({ladder.row->id, ladder.row->title, ladder.row->parts, rung.difficulty, name(rung.level),
                   what, value, name(level), Cell(rung.seconds, 3)});
      };
      for (const Mark& mark : rung.marks) add(mark.what, Cell(mark.value, 6), mark.level());
      if (!rung.trouble.empty()) add(rung.trouble, "", Level::failed);
    }
  return table;
}

std::string markdown(const std::vector<Climbed>& all, const std::vector<PeerFigure>& peers) {
  Table table = summary(all);
  table.columns.push_back("best peer");
  for (std::size_t k = 0; k < all.size(); ++k)
    table.rows[k].push_back(best_peer(peers, all[k].row->id, all[k].row->title, all[k].row->parts));
  std::string out;
  const auto append_line = [&](const auto& text_of) {
    for (std::size_t c = 0; c < table.columns.size(); ++c) out += "| " + text_of(c) + " ";
    out += "|\n";
  };
  append_line([&](std::size_t c) { return table.columns[c]; });
  append_line([](std::size_t) { return std::string("---"); });
  for (const auto& row : table.rows) append_line([&](std::size_t c) { return row[c].text; });
  return out;
}

std::string page(const std::vector<Climbed>& all, const std::vector<PeerFigure>& peers) {
  std::string out = "<!doctype html><html lang=\"en\"><meta charset=\"utf-8\"><title>Ladders</title><style>";
  out += style;
  out += "</style><h1>Hard cases, rung by rung</h1><p>A square is a rung, the easiest first: ";
  for (const Level level : {Level::gold, Level::silver, Level::bronze, Level::failed})
    out += "<span class=\"r " + std::string(name(level)) + "\"></span> " + name(level) + " &nbsp; ";
  out += "Rest the pointer on one for its figures.</p><table>";
  for (const Climbed& ladder : all) {
    out += "<tr><td>" + html(ladder.row->id) + "<td>" + html(ladder.row->title) + "<br><small>" +
           html(ladder.row->parts) + "</small><td>";
    for (const Rung& rung : ladder.rungs)
      out += "<span class=\"r " + std::string(name(rung.level)) + "\" title=\"" + html(all_figures(rung)) +
             "\"></span>";
    out += "<td><small>" + html(first_failing(ladder)) + "</small><td><small>" +
           html(best_peer(peers, ladder.row->id, ladder.row->title, ladder.row->parts)) + "</small>\n";
  }
  return out + "</table></html>\n";
}

}  // namespace ladders
