/// A small table of words and numbers, printed in aligned columns or written as CSV.
#pragma once

#include <delassus/io/inner/text.hpp>

#include <algorithm>
#include <concepts>
#include <cstdio>
#include <string>
#include <vector>

namespace delassus {

/// One entry of a table, made from a word or a number. Numbers keep `digits` significant digits and stand to
/// the right.
struct Cell {
  std::string text;  ///< as printed
  bool is_number = false;  ///< stands to the right

  /// A word.
  Cell(const char* word) : text(word) {}
  /// The same.
  Cell(std::string word) : text(std::move(word)) {}
  /// With so many significant digits.
  Cell(double number, int digits = 3) : text(inner::number_text(number, digits)), is_number(true) {}
  /// With every digit.
  Cell(std::integral auto count) : text(std::to_string(count)), is_number(true) {}
  Cell(bool) = delete;
};

/// Columns carry their unit in their name: "time per step (µs)". Every row has one cell per column.
struct Table {
  std::string title{};  ///< a line above; empty: none
  std::string caption{};  ///< a line below; empty: none
  std::vector<std::string> columns{};  ///< their names, with units
  std::vector<std::vector<Cell>> rows{};  ///< each as long as `columns`

  /// Adds a row; throws InvalidArgument when it is longer or shorter than the list of columns.
  void add(std::vector<Cell> row) {
    rows.push_back(std::move(row));
    check_row(rows.size() - 1);
  }
  /// Throws InvalidArgument where this row has more or fewer cells than there are columns.
  void check_row(std::size_t row) const {
    DELASSUS_EXPECT(rows[row].size() == columns.size(), "table '" + title + "': row #" + std::to_string(row) +
                                                            " has " + std::to_string(rows[row].size()) +
                                                            " cells for " + std::to_string(columns.size()) +
                                                            " columns");
  }
};

namespace inner {

/// How many places a terminal gives to UTF-8 text: one per code point, which holds for the units we write.
inline std::size_t printed_width(const std::string& text) {
  return std::size_t(std::count_if(text.begin(), text.end(), [](char c) { return (c & 0xC0) != 0x80; }));
}

/// A column stands to the right when every cell of it is a number.
inline bool is_numeric(const Table& table, std::size_t column) {
  for (const auto& row : table.rows)
    if (!row[column].is_number) return false;
  return !table.rows.empty();
}

inline void append_padded(std::string& out, const std::string& text, std::size_t width, bool to_the_right) {
  const std::string padding(width - printed_width(text), ' ');
  out += to_the_right ? padding + text : text + padding;
}

}  // namespace inner

/// The table as lines of equal columns, two spaces apart, under its title.
inline std::string aligned_text(const Table& table) {
  std::vector<std::size_t> widths;
  for (std::size_t row = 0; row < table.rows.size(); ++row) table.check_row(row);
  for (std::size_t c = 0; c < table.columns.size(); ++c) {
    widths.push_back(inner::printed_width(table.columns[c]));
    for (const auto& row : table.rows) widths[c] = std::max(widths[c], inner::printed_width(row[c].text));
  }
  std::string out = table.title.empty() ? "" : table.title + "\n";
  const auto append_line = [&](const auto& text_of) {
    const std::size_t start = out.size();
    for (std::size_t c = 0; c < widths.size(); ++c) {
      if (c > 0) out += "  ";
      inner::append_padded(out, text_of(c), widths[c], inner::is_numeric(table, c));
    }
    out.erase(std::max(out.find_last_not_of(' ') + 1, start));
    out += '\n';
  };
  append_line([&](std::size_t c) { return table.columns[c]; });
  append_line([&](std::size_t c) { return std::string(widths[c], '-'); });
  for (const auto& row : table.rows) append_line([&](std::size_t c) { return row[c].text; });
  if (!table.caption.empty()) out += table.caption + "\n";
  return out;
}

/// `aligned_text` to a stream.
inline void print(const Table& table, std::FILE* stream = stdout) {
  std::fputs(aligned_text(table).c_str(), stream);
}

}  // namespace delassus
