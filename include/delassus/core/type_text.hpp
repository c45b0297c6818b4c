/// The names of types, for sentences and printed code.
#pragma once

#include <cstddef>
#include <string>
#include <string_view>

namespace delassus::inner {

/// What stands behind "P = " in a function's name as the compiler has it, without the library's namespace. A template, so that a
/// program can compile it once.
template <class Char>
std::basic_string<Char> shown_type(std::basic_string_view<Char> function) {
  const std::size_t start = function.find("P = ") + 4;
  std::size_t end = start;
  for (int depth = 0; end < function.size() && (depth > 0 || (function[end] != ';' && function[end] != ']')); ++end)
    depth += (function[end] == '<' || function[end] == '(') - (function[end] == '>' || function[end] == ')');
  std::basic_string<Char> text(function.substr(start, end - start));
  constexpr std::string_view library = "delassus::";
  for (std::size_t at; (at = text.find(library)) != text.npos;) text.erase(at, library.size());
  for (std::size_t at; (at = text.find("> >")) != text.npos;) text.erase(at + 1, 1);
  return text;
}

/// The name of a type.
template <class P>
std::string type_text() {
  return shown_type(std::string_view(__PRETTY_FUNCTION__));
}

}  // namespace delassus::inner
