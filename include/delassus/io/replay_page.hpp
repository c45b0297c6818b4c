/// Writes recordings and tables as one HTML page that replays them in 3-D, without network or installation.
#pragma once

#include <delassus/io/inner/replay/page.hpp>
#include <delassus/io/inner/replay_data.hpp>
#include <delassus/io/recording.hpp>
#include <delassus/io/table.hpp>

#include <algorithm>
#include <cstdlib>
#include <initializer_list>
#include <span>
#include <string>
#include <string_view>
#include <utility>

namespace delassus {

/// What a page may cost, and a sentence or two under its title.
struct ReplayOptions {
  std::string introduction;  ///< plain text under the title
  std::size_t max_bytes = 5'000'000;  ///< contacts, then frames, are thinned until the page fits, if it can
};

namespace inner {

/// Puts each value in the place of its {{name}}; values are not searched again.
inline std::string filled(std::string_view layout,
                          std::initializer_list<std::pair<std::string_view, std::string_view>> values) {
  std::string out;
  while (true) {
    const std::size_t open = layout.find("{{");
    out += layout.substr(0, open);
    if (open == layout.npos) return out;
    const std::size_t close = layout.find("}}", open);
    for (const auto& [name, value] : values)
      if (name == layout.substr(open + 2, close - open - 2)) out += value;
    layout.remove_prefix(close + 2);
  }
}

/// A number as print has it: 5 × 10⁻⁶ for 5e-06, 10 000 for 10000, a minus for a hyphen.
inline std::string cell_html(const Cell& cell) {
  if (!cell.is_number) return html(cell.text);
  const std::size_t e = std::min(cell.text.find('e'), cell.text.size());
  std::string digits = cell.text.substr(0, e), power = cell.text.substr(e);
  const bool is_negative = digits.starts_with('-');
  if (is_negative) digits.erase(0, 1);
  if (digits.size() > 4 && digits.find_first_not_of("0123456789") == digits.npos)
    for (std::size_t i = digits.size() - 3; i < digits.size() && i > 0; i -= 3) digits.insert(i, "&#8239;");
  if (power.empty()) return (is_negative ? "−" : "") + digits;
  const int exponent = std::atoi(power.c_str() + 1);
  return (is_negative ? "−" : "") + digits + " × 10<sup>" + (exponent < 0 ? "−" : "") +
         std::to_string(std::abs(exponent)) + "</sup>";
}

inline std::string table_html(const Table& table) {
  std::string out =
      "<figure><h2>" + html(table.title) + "</h2><div class=\"wide\" tabindex=\"0\"><table><thead><tr>";
  const auto append = [&](const char* tag, std::size_t column, const std::string& text) {
    out += std::string("<") + tag + (is_numeric(table, column) ? " class=\"number\">" : ">") + text + "</" +
           tag[0] + tag[1] + ">";
  };
  for (std::size_t c = 0; c < table.columns.size(); ++c)
    append("th scope=\"col\"", c, html(table.columns[c]));
  out += "</tr></thead><tbody>";
  for (std::size_t row = 0; row < table.rows.size(); ++row) {
    table.check_row(row);
    out += "<tr>";
    for (std::size_t c = 0; c < table.columns.size(); ++c)
      append(c == 0 ? "th scope=\"row\"" : "td", c, cell_html(table.rows[row][c]));
    out += "</tr>";
  }
  out += "</tbody></table></div>";
  if (!table.caption.empty()) out += "<figcaption>" + html(table.caption) + "</figcaption>";
  return out + "</figure>";
}

}  // namespace inner

/// The page as text. Throws InvalidArgument when a recording does not hold together.
inline std::string replay_page(const std::string& title, std::span<const Recording> recordings,
                               std::span<const Table> tables = {}, const ReplayOptions& options = {}) {
  for (const Recording& recording : recordings) inner::check_recording(recording);
  std::string tables_html;
  for (const Table& table : tables) tables_html += inner::table_html(table);
  const std::string script = inner::replay_script();
  const std::size_t others = tables_html.size() + script.size() + inner::replay_style.size() +
                             inner::replay_layout.size() + inner::bytes_beside_frames(recordings);
  const auto plan = inner::plan_for(recordings, options.max_bytes - std::min(others, options.max_bytes));

  std::string data = "{\"rate\":" + inner::number_text(plan.frames_per_second, 4) +
                     ",\"contacts\":" + std::to_string(plan.contacts) + ",\"scenes\":[";
  for (std::size_t r = 0; r < recordings.size(); ++r)
    inner::append_recording(data += r > 0 ? ",\n" : "\n", recordings[r], plan);
  data += "\n]}";
  return inner::filled(inner::replay_layout, {{"title", inner::html(title)},
                                              {"introduction", inner::html(options.introduction)},
                                              {"style", inner::replay_style},
                                              {"tables", tables_html},
                                              {"data", data},
                                              {"script", script}});
}

/// Writes the page and returns its size in bytes. Throws InvalidArgument naming `path` when it cannot be
/// written.
inline std::size_t write_replay_page(const std::string& path, const std::string& title,
                                     std::span<const Recording> recordings,
                                     std::span<const Table> tables = {}, const ReplayOptions& options = {}) {
  const std::string page = replay_page(title, recordings, tables, options);
  inner::write_file(path, page);
  return page.size();
}

}  // namespace delassus
