/// What went wrong in a call, as a sentence: one world that fails leaves the others alone.
#pragma once

#include <exception>
#include <string>

namespace delassus::inner {

/// Calls f(); returns what it threw, or nothing.
template <class F>
std::string failure_of(F&& f) {
  try {
    f();
  } catch (const std::exception& error) {
    return *error.what() ? error.what() : "an exception without a sentence was thrown";
  } catch (...) {
    return "something that is no std::exception was thrown";
  }
  return {};
}

}  // namespace delassus::inner
