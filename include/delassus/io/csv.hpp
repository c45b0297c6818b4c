/// Tables and series as comma-separated values.
#pragma once

#include <delassus/io/inner/text.hpp>
#include <delassus/io/recording.hpp>
#include <delassus/io/table.hpp>

#include <string>

namespace delassus {

namespace inner {

/// A field is quoted when it holds a comma, a quote or a line end; quotes inside are doubled (RFC 4180).
inline void append_field(std::string& out, const std::string& text) {
  if (text.find_first_of(",\"\r\n") == std::string::npos) {
    out += text;
    return;
  }
  out += '"';
  for (const char c : text) out.append(c == '"' ? 2 : 1, c);
  out += '"';
}

}  // namespace inner

/// The names of the columns, then the rows. Throws where a row has more or fewer cells than there are columns.
inline std::string csv_text(const Table& table) {
  std::string out;
  const auto append_row = [&](const auto& fields, const auto& text_of) {
    for (std::size_t c = 0; c < fields.size(); ++c) {
      if (c > 0) out += ',';
      inner::append_field(out, text_of(fields[c]));
    }
    out += '\n';
  };
  append_row(table.columns, [](const std::string& name) { return name; });
  for (std::size_t row = 0; row < table.rows.size(); ++row) {
    table.check_row(row);
    append_row(table.rows[row], [](const Cell& cell) { return cell.text; });
  }
  return out;
}

/// One row per step with every digit: time (s), energy (J), residual, sweeps, then the stages (ms). A series
/// that nobody measured leaves its fields empty.
inline std::string csv_text(const RecordedSteps& steps) {
  steps.check("series");
  std::string out = "time,energy,residual,sweeps";
  for (const RecordedStage& stage : steps.stages) inner::append_field(out += ',', stage.name);
  out += '\n';
  for (std::size_t i = 0; i < steps.time.size(); ++i) {
    out += inner::number_text(steps.time[i], 17);
    const auto append = [&](const std::vector<double>& series, int digits) {
      out += ',';
      if (!series.empty()) out += inner::number_text(series[i], digits);
    };
    for (const auto* series : {&steps.energy, &steps.residual, &steps.sweeps}) append(*series, 17);
    for (const RecordedStage& stage : steps.stages) append(stage.milliseconds, 6);
    out += '\n';
  }
  return out;
}

/// Throws InvalidArgument naming `path` when it cannot be written.
inline void write_csv(const std::string& path, const Table& table) {
  inner::write_file(path, csv_text(table));
}
/// The same for the series of a recording.
inline void write_csv(const std::string& path, const RecordedSteps& steps) {
  inner::write_file(path, csv_text(steps));
}

}  // namespace delassus
