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
#include <utility>

namespace delassus {

namespace inner {

/// The short name of a type that has one.
template <class P>
std::string policy_name() {
  const std::string text = type_text<P>();
  for (const auto& [full, name] : {std::pair{type_text<AcceleratedGaussSeidel>(), "AcceleratedGaussSeidel"},
                                   std::pair{type_text<AcceleratedSweeps>(), "AcceleratedSweeps"},
                                   std::pair{type_text<AssembledCompliance>(), "AssembledCompliance"},
                                   std::pair{type_text<UncoupledCompliance>(), "UncoupledCompliance"}})
    if (text == full) return name;
  return text;
}

/// A step as C++ writes it best: 0.005, but 1. / 30.
inline std::string step_text(double h) {
  const std::string text = number_text(h, 17);
  const double rate = std::round(1 / h);
  return text.size() > 8 && rate > 1 && 1 / rate == h ? "1. / " + number_text(rate, 12) : text;
}

inline std::string member_text(bool value) { return value ? "true" : "false"; }
std::string member_text(std::integral auto value) { return std::to_string(value); }
std::string member_text(std::floating_point auto value) { return number_text(double(value), 17); }
inline std::string member_text(Criterion value) {
  const char* const names[] = {"residual", "siconos_error", "both_errors", "last_change"};
  return std::string("Criterion::") + names[int(value)];
}

/// ".name = value" for a number that differs from its default; nothing for what is no number, or is not there.
struct MemberList {
  std::string text;

  template <class P, class Member>
    requires requires(Member member, const P& policy) { member_text(member(policy)); }
  void append(const char* name, const P& policy, const P& usual, Member member) {
    if (member(policy) == member(usual)) return;
    if (text.back() != '{') text += ", ";
    text += std::string(".") + name + " = " + member_text(member(policy));
  }
  void append(const char*, const auto&, const auto&, auto) {}
};

template <class P>
concept SaysItsCode = requires(const P& policy) { { policy.code() } -> std::convertible_to<std::string>; };

}  // namespace inner

/// `ImplicitMidpoint{}`, `GaussSeidel{.tolerance = 1e-08}`: the numbers that differ from their defaults, in
/// the order in which the library declares them. A policy with other numbers says `std::string code() const`
/// itself.
template <class P>
  requires(!inner::SaysItsCode<P> && !std::is_default_constructible_v<P>)
std::string code_of(const P&) {
  return inner::policy_name<P>() + "{}";
}
/// The same of one that says its code.
template <inner::SaysItsCode P>
std::string code_of(const P& policy) {
  return policy.code();
}
/// The same of one that has defaults to compare with.
template <class P>
  requires(!inner::SaysItsCode<P> && std::is_default_constructible_v<P>)
std::string code_of(const P& policy) {
  inner::MemberList list{inner::policy_name<P>() + "{"};
  const P usual{};
  list.append("tolerance", policy, usual, [](const auto& p) -> decltype((p.tolerance)) { return p.tolerance; });
  list.append("max_iterations", policy, usual, [](const auto& p) -> decltype((p.max_iterations)) { return p.max_iterations; });
  list.append("min_iterations", policy, usual, [](const auto& p) -> decltype((p.min_iterations)) { return p.min_iterations; });
  list.append("relaxation", policy, usual, [](const auto& p) -> decltype((p.relaxation)) { return p.relaxation; });
  list.append("scale_tolerance", policy, usual, [](const auto& p) -> decltype((p.scale_tolerance)) { return p.scale_tolerance; });
  list.append("all_verified", policy, usual, [](const auto& p) -> decltype((p.all_verified)) { return p.all_verified; });
  list.append("criterion", policy, usual, [](const auto& p) -> decltype((p.criterion)) { return p.criterion; });
  list.append("frequency", policy, usual, [](const auto& p) -> decltype((p.frequency)) { return p.frequency; });
  list.append("damping_ratio", policy, usual, [](const auto& p) -> decltype((p.damping_ratio)) { return p.damping_ratio; });
  list.append("rate", policy, usual, [](const auto& p) -> decltype((p.rate)) { return p.rate; });
  list.append("max_speed", policy, usual, [](const auto& p) -> decltype((p.max_speed)) { return p.max_speed; });
  list.append("max_joint_speed", policy, usual, [](const auto& p) -> decltype((p.max_joint_speed)) { return p.max_joint_speed; });
  list.append("joint_rate", policy, usual, [](const auto& p) -> decltype((p.joint_rate)) { return p.joint_rate; });
  list.append("accuracy", policy, usual, [](const auto& p) -> decltype((p.accuracy)) { return p.accuracy; });
  list.append("length", policy, usual, [](const auto& p) -> decltype((p.length)) { return p.length; });
  list.append("horizon", policy, usual, [](const auto& p) -> decltype((p.horizon)) { return p.horizon; });
  list.append("min_step", policy, usual, [](const auto& p) -> decltype((p.min_step)) { return p.min_step; });
  list.append("max_step", policy, usual, [](const auto& p) -> decltype((p.max_step)) { return p.max_step; });
  list.append("output_step", policy, usual, [](const auto& p) -> decltype((p.output_step)) { return p.output_step; });
  list.append("per_second", policy, usual, [](const auto& p) -> decltype((p.per_second)) { return p.per_second; });
  list.append("rayleigh_mass", policy, usual, [](const auto& p) -> decltype((p.rayleigh_mass)) { return p.rayleigh_mass; });
  list.append("rayleigh_stiffness", policy, usual, [](const auto& p) -> decltype((p.rayleigh_stiffness)) { return p.rayleigh_stiffness; });
  return list.text + "}";
}

}  // namespace delassus
