/// How far an impulse is from meeting all laws of an island.
#pragma once

#include <delassus/core/cmath.hpp>

#include <algorithm>

namespace delassus {

/// With F_i(s) = s λ_i − P_K(s λ_i − ũ_i) and w_i = tr(W_ii)/rows, two measures. In velocity units and free of scale,
///
///   residual = √Σ|F_i(w_i)|² / max(|d|, |u|).
///
/// That of Siconos, which mixes units, is
///
///   siconos  = √Σ|F_i(1)|²  / max(|d|, |u|, |λ|).
///
/// Rows of different kinds are summed as they stand. In a law with rows in m/s and in rad/s, as a hinge has, both measures
/// and w depend on the unit of length. So does the moment when a solve ends. Of contacts and ball joints nothing depends on
/// units.
///
/// `worst` is the largest share of one constraint in `residual`. `floor` is what rounding leaves of it.
/// Source: [AcaryBremondHuber2018] for the natural map; the normalisation by the maximum is Siconos'.
struct Measure {
  double residual = 0;  ///< what tolerances mostly mean
  double siconos = 0;  ///< for comparison
  double worst = 0;  ///< without unit, as `residual`
  double floor = 0;  ///< no solve comes below it
  /// Σ|h w_i Δλ_i| of the last sweep, m: the change expressed as displacement. Infinite where the criterion
  /// does not ask for it.
  double last_change = 0;
  double worst_change = 0;  ///< its largest share of one constraint
};

/// Sums that become a Measure: squares all of them, worst and reach the largest ones.
struct MeasureSums {
  /// @var siconos
  /// Σ|F_i(1)|².

  /// @var d
  /// Σ|d|².

  /// @var u
  /// Σ|u|².

  /// @var lambda
  /// Σ|λ|².

  /// @var worst
  /// Largest |F_i(w_i)|².

  /// Σ|F_i(w_i)|².
  double residual = 0, siconos = 0, d = 0, u = 0, lambda = 0, worst = 0, reach = 0;  ///< largest share of rounding in it

  /// `epsilon` is that of the scalar in which the rows are.
  Measure finish(double epsilon) const {
    const double velocity = std::sqrt(std::max(d, u));
    const double mixed = std::sqrt(std::max({d, u, lambda}));
    const auto share = [](double part, double whole) { return part == 0 ? 0 : part / whole; };
    return {.residual = share(std::sqrt(residual), velocity),
            .siconos = share(std::sqrt(siconos), mixed),
            .worst = share(std::sqrt(worst), velocity),
            .floor = velocity > 0 ? 8 * epsilon * std::sqrt(reach) / velocity : 0};
  }
};

}  // namespace delassus
