/// How far an impulse is from meeting all laws of an island.
#pragma once

#include <delassus/core/cmath.hpp>

#include <algorithm>

namespace delassus {

/// With F_i(s) = s λ_i − P_K(s λ_i − ũ_i) and w_i = tr(W_ii)/rows,
///
///   residual = √Σ|F_i(w_i)|² / max(|d|, |u|)          in velocity units, free of scale;
///   siconos  = √Σ|F_i(1)|²  / max(|d|, |u|, |λ|)      the measure of Siconos, which mixes units.
///
/// Rows of different kinds are summed as they stand: in a law with rows in m/s and in rad/s, as a hinge has,
/// both and w depend on the unit of length, and with them when a solve ends. Of contacts and ball joints
/// nothing depends on units.
///
/// `worst` is the largest share of one constraint in `residual`. `floor` is what rounding leaves of it.
/// Source: [AcaryBremondHuber2018] for the natural map; the normalisation by the maximum is Siconos'.
struct Measure {
  double residual = 0;
  double siconos = 0;
  double worst = 0;
  double floor = 0;
  /// Σ|h w_i Δλ_i| of the last sweep, m: the change expressed as displacement. Infinite where the criterion
  /// does not ask for it.
  double last_change = 0;
  double worst_change = 0;  ///< its largest share of one constraint
};

/// Sums that become a Measure: squares all of them, worst and reach the largest ones.
struct MeasureSums {
  double residual = 0, siconos = 0, d = 0, u = 0, lambda = 0, worst = 0, reach = 0;

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
