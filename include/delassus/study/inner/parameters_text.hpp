/// The parameters of a run as text, by which a log knows them again.
#pragma once

#include <delassus/io/inner/text.hpp>

#include <concepts>
#include <cstddef>
#include <optional>
#include <string>
#include <string_view>
#include <tuple>
#include <type_traits>
#include <utility>

namespace delassus::inner {

/// A word as it is, or between quotes where it would not be told from others: with ends of lines or fields, and as a part of a list
/// with spaces, brackets or nothing in it.
inline std::string word_text(std::string_view word, bool is_part) {
  if (word.find_first_of(is_part ? "\t\n\r\"\\ ()" : "\t\n\r\"\\") == word.npos && !(is_part && word.empty())) return std::string(word);
  std::string text = "\"";
  for (const char c : word) {
    const std::size_t escape = std::string_view("\t\n\r\"\\").find(c);
    if (escape == std::string_view::npos) text += c;
    else text += {'\\', "tnr\"\\"[escape]};
  }
  return text + '"';
}

/// Of a number or a word, of lists and tuples of them, one space between two, those inside others in brackets, and of what has
/// `std::string code() const`; nothing of anything else. Every digit is there, and parameters of one type that differ have two texts.
template <class P>
std::optional<std::string> parameters_text(const P& parameters, bool is_part = false) {
  std::optional<std::string> text = std::string();
  bool is_first = true;
  const auto append = [&](const auto& part) {
    const std::optional<std::string> next = parameters_text(part, true);
    if (!next) text.reset();
    if (text) *text += (std::exchange(is_first, false) ? "" : " ") + *next;
  };
  const auto bracket = [&] {
    if (text && is_part) text = '(' + *text + ')';
  };
  if constexpr (requires { { parameters.code() } -> std::convertible_to<std::string>; }) text = word_text(std::string(parameters.code()), is_part);
  else if constexpr (std::is_convertible_v<const P&, std::string_view>) text = word_text(parameters, is_part);
  else if constexpr (std::is_integral_v<P>) text = std::to_string(parameters);
  else if constexpr (std::is_floating_point_v<P>) text = number_text(double(parameters), 17);
  else if constexpr (requires { parameters.begin() != parameters.end(); }) {
    for (const auto& part : parameters) append(part);
    bracket();
  } else if constexpr (requires { std::tuple_size<P>::value; }) {
    std::apply([&](const auto&... part) { (append(part), ...); }, parameters);
    bracket();
  } else {
    text.reset();
  }
  return text;
}

}  // namespace delassus::inner
