/// The C++ text that makes a policy: what a study prints for its reader to paste.
#pragma once

#include <delassus/compliance/assembled.hpp>
#include <delassus/compliance/uncoupled.hpp>
#include <delassus/core/cmath.hpp>
#include <delassus/core/type_text.hpp>
#include <delassus/io/inner/text.hpp>
#include <delassus/solvers/accelerated_gauss_seidel.hpp>
#include <delassus/solvers/gauss_seidel.hpp>

#include <concepts>
#include <cstddef>
#include <string>
#include <type_traits>

namespace delassus {

namespace inner {

template <class P>
std::string policy_name() {
  if constexpr (std::is_same_v<P, AcceleratedGaussSeidel>)
    return "AcceleratedGaussSeidel";
  else if constexpr (std::is_same_v<P, GaussSeidel>)
    return "GaussSeidel";
  else if constexpr (std::is_same_v<P, AssembledCompliance>)
    return "AssembledCompliance";
  else if constexpr (std::is_same_v<P, UncoupledCompliance>)
    return "UncoupledCompliance";
  else
    return type_text<P>();
}

/// A step as C++ writes it best: 0.005, but 1. / 30.
inline std::string step_text(double h) {
  const std::string text = number_text(h, 17);
  const double rate = std::round(1 / h);
  return text.size() > 8 && rate > 1 && 1 / rate == h ? "1. / " + number_text(rate, 12) : text;
}

/// ".name = value" for a number that differs from its default.
template <class T>
void append_member(std::string& out, const char* name, const T& value, const T& usual) {
  if (value == usual) return;
  if (out.back() != '{') out += ", ";
  out += std::string(".") + name + " = ";
  if constexpr (std::is_same_v<T, Criterion>)
    out += value == Criterion::residual ? "Criterion::residual" : value == Criterion::siconos_error ? "Criterion::siconos_error" : "Criterion::last_change";
  else if constexpr (std::is_same_v<T, bool>)
    out += value ? "true" : "false";
  else if constexpr (std::is_integral_v<T>)
    out += std::to_string(value);
  else
    out += number_text(double(value), 17);
}

}  // namespace inner

/// `ImplicitMidpoint{}`, `GaussSeidel{.tolerance = 1e-08}`: the numbers that differ from their defaults, in
/// the order in which the library declares them. A policy with other numbers says `std::string code() const`
/// itself.
template <class P>
std::string code_of(const P& policy) {
  if constexpr (requires {
                  { policy.code() } -> std::convertible_to<std::string>;
                }) {
    return policy.code();
  } else {
    std::string out = inner::policy_name<P>() + "{";
    if constexpr (std::is_default_constructible_v<P>) {
      const P usual{};
      const auto append = [&](const char* name, const auto& member) {
        if constexpr (requires { requires std::is_arithmetic_v<std::remove_cvref_t<decltype(member(usual))>> || std::is_same_v<std::remove_cvref_t<decltype(member(usual))>, Criterion>; })
          inner::append_member(out, name, member(policy), member(usual));
      };
      append("tolerance", [](const auto& p) -> decltype((p.tolerance)) { return p.tolerance; });
      append("max_iterations", [](const auto& p) -> decltype((p.max_iterations)) { return p.max_iterations; });
      append("min_iterations", [](const auto& p) -> decltype((p.min_iterations)) { return p.min_iterations; });
      append("relaxation", [](const auto& p) -> decltype((p.relaxation)) { return p.relaxation; });
      append("scale_tolerance", [](const auto& p) -> decltype((p.scale_tolerance)) { return p.scale_tolerance; });
      append("all_verified", [](const auto& p) -> decltype((p.all_verified)) { return p.all_verified; });
      append("criterion", [](const auto& p) -> decltype((p.criterion)) { return p.criterion; });
      append("frequency", [](const auto& p) -> decltype((p.frequency)) { return p.frequency; });
      append("damping_ratio", [](const auto& p) -> decltype((p.damping_ratio)) { return p.damping_ratio; });
      append("rate", [](const auto& p) -> decltype((p.rate)) { return p.rate; });
      append("max_speed", [](const auto& p) -> decltype((p.max_speed)) { return p.max_speed; });
      append("max_joint_speed", [](const auto& p) -> decltype((p.max_joint_speed)) { return p.max_joint_speed; });
      append("joint_rate", [](const auto& p) -> decltype((p.joint_rate)) { return p.joint_rate; });
      append("rayleigh_mass", [](const auto& p) -> decltype((p.rayleigh_mass)) { return p.rayleigh_mass; });
      append("rayleigh_stiffness", [](const auto& p) -> decltype((p.rayleigh_stiffness)) { return p.rayleigh_stiffness; });
    }
    return out + "}";
  }
}

}  // namespace delassus
