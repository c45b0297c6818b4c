/// Restitution of one row: when it bounces, and with what velocity.
#pragma once

#include <delassus/core/cmath.hpp>

#include <algorithm>

namespace delassus {

/// What the rows of a body do together: else corners of a face that lands would differ by rounding.
enum class Together : unsigned char { undecided, leave_at_once, land };

/// What a row that closes does. Both zero: it comes to the surface and stays.
struct Rebound {
  double leaves = 0;  ///< the velocity at the end of this step, > 0
  double parts = 0;   ///< it lands in this step, and parts from the surface with this speed in the next one, > 0
};

/// A row at the start of a step of h seconds, opening positive. m and s, or rad and s.
struct Closing {
  double gap;           ///< x
  double velocity;      ///< V < 0, now
  double acceleration;  ///< a ≤ 0
  double height;        ///< from which it leaves at the start of the step, as if it had flown from there: x where u moves it
  double least;         ///< with less than this speed it does not part
  double h;             ///< of the step, s
  bool may_land;        ///< it may reach the surface within the step
  Together others = Together::undecided;  ///< what other rows of the body do
};

/// The row has the speed V_s at the surface, V_s² = V² − 2 a x. It leaves with
///
///   u = √(e² V_s² + 2 a x) + a h/2,
///
/// so that ½ V² − a x, which a step that moves by u keeps, becomes e² of what it is at the surface, wherever the step meets it. This leaves out the flight from x to the
/// surface and back. Where u < 0, or where waiting for the end of the step is the smaller error in time, the row lands, and bounces
/// from the surface in the next step. So errors in time do not add up. Where no bounce is the last one they need not.
inline Rebound rebound(const Closing& c, double e) {
  const double x = c.gap, a = c.acceleration;
  const double meets = std::sqrt(std::max(0.0, c.velocity * c.velocity - 2 * a * x)), parts = e * meets;
  if (!(parts > c.least)) return {};
  const double square = parts * parts + 2 * a * c.height, starts = std::sqrt(std::max(0.0, square)), leaves = starts + 0.5 * a * c.h;
  if (square > 0 && leaves > 0) {
    const double down = 2 * x / (meets - c.velocity), up = 2 * x / (parts + starts);  // s
    const bool is_sooner = c.others == Together::undecided ? down + up < c.h - down : c.others == Together::leave_at_once;
    if (!c.may_land || a == 0 || e == 1 || is_sooner) return {.leaves = leaves};
  }
  return c.may_land ? Rebound{.parts = parts} : Rebound{};
}

}  // namespace delassus
