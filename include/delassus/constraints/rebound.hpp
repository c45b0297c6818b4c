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

/// A row as a step meets it, opening positive. Lengths in m, or angles in rad.
struct Closing {
  double gap;           ///< x
  double velocity;      ///< v < 0 of the last step, per s
  double change;        ///< what its acceleration makes of v in half a step, ≤ 0, less what v is older than x: a h/2 of symplectic Euler
  double acceleration;  ///< a ≤ 0, per s²
  double h;             ///< s
  double least;         ///< with less than this speed it does not part
  bool may_land;
};

/// The row has the speed V_s at the surface, V_s² = V² − 2 a x with V = v + `change`. It leaves with
///
///   u = `change` + √(e² V_s² + 2 a x),
///
/// so that ½ V² − a x becomes e² of what it is at the surface, wherever the step meets it. e = 1 gives u = −v. This leaves out the
/// flight from x to the surface and back. Where u < 0, or where waiting for the end of the step is the smaller error in time, the
/// row lands, and bounces from the surface in the next step. So errors in time do not add up.
inline Rebound rebound(const Closing& c, double e) {
  const double x = c.gap, a = c.acceleration, now = c.velocity + c.change;
  const double meets = std::sqrt(std::max(0.0, now * now - 2 * a * x)), parts = e * meets;
  if (!(parts > c.least)) return {};
  const double square = parts * parts + 2 * a * x, here = std::sqrt(std::max(0.0, square)), leaves = c.change + here;
  const bool lasts = a == 0 || e == 1;  // no bounce is the last: no time to rest
  if (square > 0 && leaves > 0) {
    const double down = 2 * x / (meets - now), up = 2 * x / (parts + here);  // s
    if (!c.may_land || lasts || down + up < c.h - down) return {.leaves = leaves};
  }
  return c.may_land ? Rebound{.parts = parts} : Rebound{};
}

}  // namespace delassus
