/// How far an impulse is from meeting all laws of an island.
#pragma once

#include <delassus/core/cmath.hpp>

#include <algorithm>
#include <limits>

namespace delassus {

/// With F_i(s) = s λ_i − P_K(s λ_i − ũ_i), w_i = tr(W_ii)/rows and c_i = min(0, u_n) at a contact or a limit, what goes on into it:
///
///   residual = √Σ max(|F_i(w_i)|², c_i²) / max(|d|, |u|),   closing = √Σ c_i² / max(|d|, |u|).
///
/// Both are free of scale. The first bounds the second: |F_i| alone would not, which is |c_i|/√(1 + μ²) where λ_i is zero. That
/// of Siconos, which mixes units, is
///
///   siconos  = √Σ|F_i(1)|²  / max(|d|, |u|, |λ|).
///
/// Rows in rad/s count as m/s at the island's length L, `inner::length_of_island`, and w_i is a number for each unit. So
/// `residual`, and when a solve ends, depend on no unit. `worst` is the largest share of one constraint in `residual`. `floor`
/// is what rounding leaves of it. Where numbers overflow the errors are infinite. Where squares of velocities vanish the errors
/// are 1 and `floor` is infinite. Source: [AcaryBremondHuber2018] for the natural map; the normalisation by the maximum is Siconos'.
struct Measure {
  double residual = 0;  ///< what tolerances mostly mean
  double siconos = 0;  ///< for comparison
  double worst = 0;  ///< without unit, as `residual`
  double floor = 0;  ///< no solve comes below it
  double closing = 0;  ///< without unit, as `residual`
  /// Σ|h w_i Δλ_i| of the last sweep, m: the change expressed as displacement. Infinite where the criterion
  /// does not ask for it.
  double last_change = 0;
  double worst_change = 0;  ///< its largest share of one constraint
  double sinking = 0;  ///< h √Σ c_i², m: how far the step goes into what it shall not

  /// Whether rounding hides the rest. Rounding that hides a tenth of the motion ends no solve: the scalar cannot hold the problem,
  /// and the larger a wrong λ is, the more it hides.
  bool is_at_floor() const { return residual <= floor && (floor <= 0.1 || floor == infinity); }

  /// Of velocities whose squares vanish.
  static Measure of_nothing() { return {.residual = 1, .siconos = 1, .worst = 1, .floor = infinity, .closing = 1}; }
  /// Of numbers that are not finite.
  static Measure of_overflow() {
    return {.residual = infinity, .siconos = infinity, .worst = infinity, .closing = infinity};
  }

 private:
  static constexpr double infinity = std::numeric_limits<double>::infinity();
};

/// Sums that become a Measure: squares all of them, worst and reach the largest ones.
struct MeasureSums {
  double length = 1;  ///< L, m
  /// @var siconos
  /// Σ|F_i(1)|².

  /// @var d
  /// Σ|d|².

  /// @var u
  /// Σ|u|².

  /// @var lambda
  /// Σ|λ|².

  /// @var closing
  /// Σ c_i².

  /// @var worst
  /// Largest max(|F_i(w_i)|², c_i²).

  /// Σ max(|F_i(w_i)|², c_i²).
  double residual = 0, siconos = 0, d = 0, u = 0, lambda = 0, closing = 0, worst = 0, reach = 0;  ///< largest share of rounding in it

  /// Whether the squares of all velocities are too small to compare.
  bool has_vanished() const { return std::max(d, u) < 1e-280; }

  /// `epsilon` is that of the scalar in which the rows are.
  [[gnu::always_inline]] Measure finish(double epsilon) const {
    if (!std::isfinite(residual + d + u)) return Measure::of_overflow();
    const double velocity = std::sqrt(std::max(d, u));
    if (has_vanished() && velocity > 0) return Measure::of_nothing();
    const double mixed = std::sqrt(std::max(std::max(d, u), lambda));
    const auto share = [](double part, double whole) { return part == 0 ? 0 : part / whole; };
    return {.residual = share(std::sqrt(residual), velocity),
            .siconos = std::isfinite(mixed) ? share(std::sqrt(siconos), mixed) : mixed,
            .worst = share(std::sqrt(worst), velocity),
            .floor = velocity > 0 ? std::min(8 * epsilon * std::sqrt(reach) / velocity, std::numeric_limits<double>::max()) : 0,
            .closing = share(std::sqrt(closing), velocity)};
  }
};

}  // namespace delassus
