/// The names of types, for sentences and printed code.
#pragma once

#include <cstddef>
#include <string>
#include <string_view>

namespace delassus::inner {

/// The name of a type as the compiler has it, without the library's namespace.
template <class P>
std::string type_text() {
  const std::string_view all = __PRETTY_FUNCTION__;
  const std::size_t start = all.find("P = ") + 4;
  std::size_t end = start;
  for (int depth = 0; end < all.size() && (depth > 0 || (all[end] != ';' && all[end] != ']')); ++end)
    depth += (all[end] == '<' || all[end] == '(') - (all[end] == '>' || all[end] == ')');
  std::string text(all.substr(start, end - start));
  constexpr std::string_view library = "delassus::";
  for (std::size_t at; (at = text.find(library)) != text.npos;) text.erase(at, library.size());
  for (std::size_t at; (at = text.find("> >")) != text.npos;) text.erase(at + 1, 1);
  return text;
}

}  // namespace delassus::inner
