/// The parameters of a run as text, by which a log knows them again.
#pragma once

#include <delassus/io/inner/text.hpp>
#include <delassus/study/inner/run_log.hpp>

#include <concepts>
#include <optional>
#include <string>
#include <string_view>
#include <tuple>
#include <type_traits>

namespace delassus::inner {

/// Of a number or a word, of lists and tuples of them, one space between two, and of what has `std::string code() const`; nothing
/// of anything else. Every digit is there.
template <class P>
std::optional<std::string> parameters_text(const P& parameters) {
  std::optional<std::string> text = std::string();
  const auto append = [&](const auto& part) {
    const std::optional<std::string> next = parameters_text(part);
    if (!next) text.reset();
    if (text) *text += (text->empty() ? "" : " ") + *next;
  };
  if constexpr (requires { { parameters.code() } -> std::convertible_to<std::string>; }) text = parameters.code();
  else if constexpr (std::is_convertible_v<const P&, std::string_view>) text = std::string_view(parameters);
  else if constexpr (std::is_integral_v<P>) text = std::to_string(parameters);
  else if constexpr (std::is_floating_point_v<P>) text = number_text(double(parameters), 17);
  else if constexpr (requires { parameters.begin() != parameters.end(); }) {
    for (const auto& part : parameters) append(part);
  } else if constexpr (requires { std::tuple_size<P>::value; }) {
    std::apply([&](const auto&... part) { (append(part), ...); }, parameters);
  } else {
    text.reset();
  }
  if (text) text = field_text(*std::move(text));
  return text;
}

}  // namespace delassus::inner
