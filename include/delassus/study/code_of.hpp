/// The C++ text that makes a policy: what a study prints for its reader to paste.
#pragma once

#include <delassus/compliance/assembled.hpp>
#include <delassus/compliance/uncoupled.hpp>
#include <delassus/core/type_text.hpp>
#include <delassus/io/inner/text.hpp>
#include <delassus/solvers/accelerated_gauss_seidel.hpp>
#include <delassus/solvers/gauss_seidel.hpp>

#include <cmath>
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
  if constexpr (std::is_same_v<T, bool>)
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
      const auto append = [&](const char* name, const auto& value, const auto& other) {
        if constexpr (std::is_arithmetic_v<std::remove_cvref_t<decltype(value)>>)
          inner::append_member(out, name, value, other);
      };
      if constexpr (requires { policy.tolerance; }) append("tolerance", policy.tolerance, usual.tolerance);
      if constexpr (requires { policy.max_iterations; })
        append("max_iterations", policy.max_iterations, usual.max_iterations);
      if constexpr (requires { policy.min_iterations; })
        append("min_iterations", policy.min_iterations, usual.min_iterations);
      if constexpr (requires { policy.relaxation; })
        append("relaxation", policy.relaxation, usual.relaxation);
      if constexpr (requires { policy.scale_tolerance; })
        append("scale_tolerance", policy.scale_tolerance, usual.scale_tolerance);
      if constexpr (requires { policy.all_verified; })
        append("all_verified", policy.all_verified, usual.all_verified);
      if constexpr (requires { policy.frequency; }) append("frequency", policy.frequency, usual.frequency);
      if constexpr (requires { policy.damping_ratio; })
        append("damping_ratio", policy.damping_ratio, usual.damping_ratio);
      if constexpr (requires { policy.rate; }) append("rate", policy.rate, usual.rate);
      if constexpr (requires { policy.max_speed; }) append("max_speed", policy.max_speed, usual.max_speed);
      if constexpr (requires { policy.max_joint_speed; })
        append("max_joint_speed", policy.max_joint_speed, usual.max_joint_speed);
      if constexpr (requires { policy.joint_rate; })
        append("joint_rate", policy.joint_rate, usual.joint_rate);
      if constexpr (requires { policy.rayleigh_mass; })
        append("rayleigh_mass", policy.rayleigh_mass, usual.rayleigh_mass);
      if constexpr (requires { policy.rayleigh_stiffness; })
        append("rayleigh_stiffness", policy.rayleigh_stiffness, usual.rayleigh_stiffness);
    }
    return out + "}";
  }
}

}  // namespace delassus
