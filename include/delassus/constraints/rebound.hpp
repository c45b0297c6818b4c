/// Restitution of one row: when it bounces, and with what velocity.
#pragma once

#include <delassus/core/cmath.hpp>

#include <algorithm>

namespace delassus {

/// What a row that closes does. Both zero: it comes to the surface and stays.
struct Rebound {
  double leaves = 0;  ///< the velocity at the end of this step, > 0
  double parts = 0;   ///< it lands in this step, and parts from the surface with this speed in the next one, > 0
};

/// The velocity at the end of a step that begins at the surface with the speed `parts` (≥ 0, m/s), under a ≤ 0 m/s².
inline double velocity_after_parting(double parts, double a, double h) { return parts + 0.5 * a * h; }

/// A row with the gap x (m), the velocity v < 0 of the last step (m/s) and the acceleration a ≤ 0 (m/s²) has the speed V_s at the
/// surface, V_s² = (v + a h/2)² − 2 a x, for v is the velocity half a step ago. It leaves with
///
///   u = a h/2 + √(e² V_s² + 2 a x),
///
/// so that ½ V² − a x, which symplectic Euler keeps, becomes e² of what it is at the surface, wherever the step meets it. e = 1 gives
/// u = −v. This leaves out the flight from x to the surface and back. Where u < 0, or where waiting for the end of the step is the
/// smaller error in time, the row lands, and bounces from the surface in the next step. So errors in time do not add up.
/// A row that parts with less than `least` (m/s) stays. SI units; angles in the place of lengths do too.
inline Rebound rebound(double x, double v, double a, double e, double h, double least) {
  const double half = 0.5 * a * h, now = v + half;
  const double meets = std::sqrt(std::max(0.0, now * now - 2 * a * x)), parts = e * meets;
  if (!(parts > least)) return {};
  const double square = parts * parts + 2 * a * x, here = std::sqrt(std::max(0.0, square)), leaves = half + here;
  if (square > 0 && leaves > 0) {
    const double down = 2 * x / (meets - now), up = 2 * x / (parts + here);  // times, s
    if (a == 0 || e == 1 || down + up < h - down) return {.leaves = leaves};
  }
  return {.parts = parts};
}

}  // namespace delassus
