/// Bad input is refused where it enters, in one sentence that says what, where and how to mend.
#pragma once

#include <delassus/core/cmath.hpp>

#include <cstdio>
#include <stdexcept>
#include <string>
#include <string_view>

namespace delassus {

/// Thrown by whatever takes input from a user; never by a step.
struct InvalidArgument : std::invalid_argument {
  using std::invalid_argument::invalid_argument;
};

namespace inner {

[[noreturn]] inline void refuse(const std::string& sentence) { throw InvalidArgument("delassus: " + sentence); }

/// A number as a person writes it: six digits, no trailing zeros.
inline std::string text(double value) {
  char buffer[32];
  std::snprintf(buffer, sizeof buffer, "%g", value);
  return buffer;
}

/// The sentence "`what` `value` `unit` `rule`". A template, so that a program can compile it once.
template <class Char>
[[noreturn, gnu::cold]] void refuse_number(std::basic_string_view<Char> what, double value, const char* rule, const char* unit) {
  const std::string space = *unit ? " " : "";
  refuse(std::string(what) + " " + text(value) + space + unit + " " + rule);
}

/// Refuses a number unless the rule holds. Policies are checked before each step, so what holds costs its comparison alone.
inline void expect_number(bool holds, std::string_view what, double value, const char* rule, const char* unit = "") {
  if (!holds) refuse_number(what, value, rule, unit);
}
inline void expect_positive(std::string_view what, double value, const char* unit = "") {
  expect_number(std::isfinite(value) && value > 0, what, value, "must be finite and > 0", unit);
}
inline void expect_not_negative(std::string_view what, double value, const char* unit = "") {
  expect_number(std::isfinite(value) && value >= 0, what, value, "must be finite and >= 0", unit);
}
/// It may be infinite.
inline void expect_above_zero(std::string_view what, double value, const char* unit = "") {
  expect_number(value > 0, what, value, "must be > 0", unit);
}
inline void expect_at_least_zero(std::string_view what, double value, const char* unit = "") {
  expect_number(value >= 0, what, value, "must be >= 0", unit);
}
inline void expect_at_least_one(std::string_view what, double value) {
  expect_number(value >= 1, what, value, "must be >= 1");
}
inline void expect_zero_to_one(std::string_view what, double value) {
  expect_number(value >= 0 && value <= 1, what, value, "must be in [0, 1]");
}

}  // namespace inner
}  // namespace delassus

/// Refuses with `sentence` (an expression that makes a std::string, evaluated only on failure).
#define DELASSUS_EXPECT(condition, sentence)                \
  do {                                                      \
    if (!(condition)) ::delassus::inner::refuse(sentence);  \
  } while (false)
