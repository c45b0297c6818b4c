/// Orders of convergence, measured.
#pragma once

#include <array>
#include <cmath>
#include <cstddef>

/// p of an error c hᵖ, from its size at a step and at that step divided by `ratio`.
inline double convergence_order(double coarse, double fine, double ratio = 2) {
  return std::log(coarse / fine) / std::log(ratio);
}

/// Of two runs of a study that follow each other, `first` and the next, in measure m.
template <class Study>
requires requires(const Study& study) { study.runs; }
double convergence_order(const Study& study, int first, int m = 0) {
  const auto error = [&](int k) { return study.runs[std::size_t(k)].errors[std::size_t(m)]; };
  return convergence_order(error(first), error(first + 1));
}

/// The orders of the last two pairs of four errors, each at half the step of the one before: one pair alone
/// can be a zero of the error that happens to lie there.
template <class ErrorOf>
std::array<double, 2> convergence_orders(const ErrorOf& error_of, double h) {
  std::array<double, 4> error{};
  for (std::size_t k = 0; k < error.size(); ++k, h /= 2) error[k] = error_of(h);
  return {convergence_order(error[1], error[2]), convergence_order(error[2], error[3])};
}

/// Whether both lie in [p − 0.15, p + 0.5].
inline bool are_of_order(const std::array<double, 2>& orders, double p) {
  bool are = true;
  for (const double order : orders) are = are && order >= p - 0.15 && order <= p + 0.5;
  return are;
}
