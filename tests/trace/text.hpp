/// Numbers as words, exact: what the trace programs store and read.
#pragma once

#include <bit>
#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <stdexcept>
#include <string>
#include <type_traits>

namespace trace {

/// One walk writes and reads: `text(x)` appends x, or gives it the next word. An integer is a decimal number,
/// a floating-point one the 16 hexadecimal digits of its bits as a double, without the zeros at their end.
class Text {
 public:
  Text() = default;
  explicit Text(std::string written) : reads_(true), words_(std::move(written)) {}

  bool reads() const { return reads_; }
  bool is_at_end() {
    skip();
    return at_ == words_.size();
  }
  const std::string& words() const { return words_; }

  /// Begins a line of this name.
  void line(const char* name) {
    if (!reads_) {
      if (!words_.empty()) words_ += '\n';
      words_ += name;
    } else if (const std::string found = next(); found != name) {
      throw std::runtime_error("the data say '" + found + "' where '" + name + "' is due");
    }
  }

  /// Whether the line that comes has this name.
  bool is_next(const char* name) {
    const std::size_t here = at_;
    const bool is = !is_at_end() && next() == name;
    at_ = here;
    return is;
  }

  template <class X>
  requires std::is_arithmetic_v<X>
  void operator()(X& x) {
    if constexpr (std::is_floating_point_v<X>) {
      if (reads_)
        x = X(real(next()));
      else
        word(real(double(x)));
    } else {
      if (reads_)
        x = X(std::strtoll(next().c_str(), nullptr, 10));
      else
        word(std::to_string(static_cast<long long>(x)));
    }
  }
  void operator()(std::uint64_t& x) {
    if (reads_)
      x = std::strtoull(next().c_str(), nullptr, 10);
    else
      word(std::to_string(x));
  }
  /// The length of a list, which the reader of it takes on.
  template <class List>
  void size(List& list) {
    std::uint64_t count = list.size();
    (*this)(count);
    if (reads_) list.resize(std::size_t(count));
  }

 private:
  static std::string real(double x) {
    char digits[17];
    std::snprintf(digits, sizeof digits, "%016llx",
                  static_cast<unsigned long long>(std::bit_cast<std::uint64_t>(x)));
    std::size_t count = 16;
    while (count > 1 && digits[count - 1] == '0') --count;
    return {digits, count};
  }
  static double real(std::string digits) {
    digits.resize(16, '0');
    return std::bit_cast<double>(std::uint64_t(std::strtoull(digits.c_str(), nullptr, 16)));
  }
  void word(const std::string& w) { words_ += ' ' + w; }
  void skip() {
    while (at_ < words_.size() && std::strchr(" \n", words_[at_])) ++at_;
  }
  std::string next() {
    skip();
    if (at_ == words_.size()) throw std::runtime_error("the data end early");
    const std::size_t end = std::min(words_.find_first_of(" \n", at_), words_.size());
    std::string w = words_.substr(at_, end - at_);
    at_ = end;
    return w;
  }

  bool reads_ = false;
  std::string words_;
  std::size_t at_ = 0;
};

}  // namespace trace
