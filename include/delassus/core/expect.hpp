/// Bad input is refused where it enters, in one sentence that says what, where and how to mend.
#pragma once

#include <cstdio>
#include <stdexcept>
#include <string>

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

}  // namespace inner
}  // namespace delassus

/// Refuses with `sentence` (an expression that makes a std::string, evaluated only on failure).
#define DELASSUS_EXPECT(condition, sentence)                \
  do {                                                      \
    if (!(condition)) ::delassus::inner::refuse(sentence);  \
  } while (false)
