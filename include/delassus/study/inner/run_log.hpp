/// The file of a job's finished runs, a line each: an interrupted job goes on from it, and files joined end to end read as one.
#pragma once

#include <delassus/core/expect.hpp>
#include <delassus/io/inner/text.hpp>
#include <delassus/io/state_hash.hpp>

#include <charconv>
#include <cstdint>
#include <cstdio>
#include <fstream>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <system_error>
#include <utility>
#include <vector>

namespace delassus::inner {

/// Sixteen digits for the bits of a number, such as a fingerprint.
inline std::string hex_text(std::uint64_t value) {
  char buffer[20];
  std::snprintf(buffer, sizeof buffer, "%016llx", static_cast<unsigned long long>(value));
  return buffer;
}

/// What `hex_text` wrote; nothing for anything else.
inline std::optional<std::uint64_t> hex_in(std::string_view field) {
  std::uint64_t value = 0;
  const auto [end, error] = std::from_chars(field.data(), field.data() + field.size(), value, 16);
  return field.size() == 16 && error == std::errc{} && end == field.data() + 16 ? std::optional(value) : std::nullopt;
}

/// The first field of all lines of one job: a number for all that must agree before its runs can stand in one table.
inline std::string key_of_text(std::string_view text) {
  Fingerprint print;
  print.bytes(text.data(), text.size());
  return hex_text(print.value);
}

/// The whole field as a number; nothing where it is none.
inline std::optional<double> number_in(std::string_view field) {
  double value = 0;
  const auto [end, error] = std::from_chars(field.data(), field.data() + field.size(), value);
  return error == std::errc{} && end == field.data() + field.size() ? std::optional(value) : std::nullopt;
}

/// The whole field as a count of 0 … most; −1 for what somebody else wrote there.
inline long count_in(std::string_view field, double most) {
  const double value = number_in(field).value_or(-1);
  return value >= 0 && value <= most ? long(value) : -1l;
}

/// Words without tabs and line ends, so that they fit into a field.
inline std::string field_text(std::string text) {
  for (char& c : text)
    if (c == '\t' || c == '\n' || c == '\r') c = ' ';
  return text;
}

/// Fields are separated by tabs. A line that was cut short stays recognisable: it never gets a line end of its own.
class RunLog {
 public:
  /// An empty path keeps nothing. `whose` is for messages: "the study's log".
  RunLog(std::string path, std::string whose) : path_(std::move(path)), whose_(std::move(whose)) {}

  /// f(fields) for each line of the file that was written whole and is not a comment: that begins with `#`.
  template <class F>
  void each_line(F&& f) {
    is_empty_ = true;
    ends_midway_ = false;
    if (path_.empty()) return;
    std::ifstream file(path_, std::ios::binary);
    std::vector<std::string_view> fields;
    for (std::string line; std::getline(file, line);) {
      is_empty_ = false;
      ends_midway_ = file.eof();
      if (ends_midway_ || line.empty() || line[0] == '#') continue;
      split(line, fields);
      f(std::span<const std::string_view>(fields));
    }
  }

  /// Appends a line and closes the file. Throws InvalidArgument when it cannot be written.
  void append(std::string line) {
    line += '\n';
    if (std::exchange(ends_midway_, false)) line.insert(0, " was cut short\n");
    write(line);
  }
  /// The comment that a new file begins with; other files are opened alone, so that one that cannot be written is refused now.
  void begin(const std::string& comment) { write(std::exchange(is_empty_, false) ? "# " + comment + "\n" : std::string()); }

  bool is_kept() const { return !path_.empty(); }
  const std::string& path() const { return path_; }

 private:
  static void split(std::string_view line, std::vector<std::string_view>& fields) {
    fields.clear();
    for (std::size_t start = 0, end; start <= line.size(); start = end + 1) {
      end = line.find('\t', start);
      if (end == std::string_view::npos) end = line.size();
      fields.push_back(line.substr(start, end - start));
    }
  }

  void write(const std::string& text) const {
    if (path_.empty()) return;
    std::FILE* file = std::fopen(path_.c_str(), "ab");
    DELASSUS_EXPECT(file != nullptr, "cannot open " + whose_ + " '" + path_ + "' for writing; does its folder exist?");
    const bool is_written = std::fwrite(text.data(), 1, text.size(), file) == text.size();
    const bool is_closed = std::fclose(file) == 0;
    DELASSUS_EXPECT(is_written && is_closed, "cannot write all of " + whose_ + " '" + path_ + "'; is the disk full?");
  }

  std::string path_, whose_;
  bool is_empty_ = true, ends_midway_ = false;  ///< in a line that a crash cut short
};

}  // namespace delassus::inner
