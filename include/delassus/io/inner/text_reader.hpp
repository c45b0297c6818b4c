/// Numbers and words of a text file, one after the other, with the line they stand on.
#pragma once

#include <delassus/core/cmath.hpp>
#include <delassus/core/expect.hpp>
#include <delassus/math/linear.hpp>

#include <charconv>
#include <cstdio>
#include <memory>
#include <string>
#include <string_view>
#include <system_error>

namespace delassus::inner {

/// The bytes of a file; throws InvalidArgument naming it when it cannot be read.
inline std::string read_text(const std::string& path) {
  const std::unique_ptr<std::FILE, int (*)(std::FILE*)> file(std::fopen(path.c_str(), "rb"), std::fclose);
  DELASSUS_EXPECT(file != nullptr,
                  "cannot open '" + path + "' for reading; is it there, and may you read it?");
  std::string text;
  char part[1 << 16];
  for (std::size_t count; (count = std::fread(part, 1, sizeof part, file.get())) > 0;)
    text.append(part, count);
  DELASSUS_EXPECT(std::ferror(file.get()) == 0, "cannot read all of '" + path + "'");
  return text;
}

/// Words parted by white space. What is asked for and not there is refused with path, line and `what` was
/// expected.
class TextReader {
 public:
  TextReader(std::string_view text, std::string path) : text_(text), path_(std::move(path)) {}

  bool is_at_end() {
    while (at_ < text_.size() && is_space(text_[at_])) line_ += text_[at_++] == '\n';
    return at_ == text_.size();
  }

  std::string_view word(const std::string& what) {
    if (is_at_end()) refuse_here("the file ends where " + what + " should stand");
    const std::size_t start = at_;
    while (at_ < text_.size() && !is_space(text_[at_])) ++at_;
    return text_.substr(start, at_ - start);
  }

  /// A finite number.
  double number(const std::string& what) {
    const std::string_view text = word(what);
    double value = 0;
    const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
    if (error != std::errc{} || end != text.data() + text.size() || !std::isfinite(value))
      refuse_here("'" + std::string(text.substr(0, 40)) + "' is no finite number, but " + what +
                  " should stand there");
    return value;
  }

  /// Three finite numbers.
  Vec3 vector(const std::string& what) {
    Vec3 v;
    for (double& x : v) x = number(what);
    return v;
  }

  /// A whole number in [low, high].
  int integer(const std::string& what, int low, int high) {
    const std::string_view text = word(what);
    int value = 0;
    const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
    if (error != std::errc{} || end != text.data() + text.size() || value < low || value > high)
      refuse_here("'" + std::string(text.substr(0, 40)) + "' is no whole number from " + std::to_string(low) +
                  " to " + std::to_string(high) + ", but " + what + " should stand there");
    return value;
  }

  /// Passes over what is left of the line.
  void pass_line() {
    while (at_ < text_.size() && text_[at_] != '\n') ++at_;
  }

  /// The line that the last word stands on.
  int line() const { return line_; }
  [[noreturn]] void refuse_here(const std::string& reason) const { refuse_at(line_, reason); }
  [[noreturn]] void refuse_at(int line, const std::string& reason) const {
    refuse(path_ + ", line " + std::to_string(line) + ": " + reason);
  }

 private:
  static bool is_space(char c) { return c == ' ' || c == '\n' || c == '\t' || c == '\r'; }

  std::string_view text_;
  std::string path_;
  std::size_t at_ = 0;
  int line_ = 1;
};

}  // namespace delassus::inner
