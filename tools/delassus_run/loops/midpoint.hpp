/// A loop for joints of any kind, its steps of second order.
#pragma once

#include "loop_of.hpp"  // before all else

#include <delassus/stabilisation/closed_joints.hpp>

namespace delassus_run {

inline auto midpoint_loop(const Asked& asked) {
  return loop_of(asked, every_law(asked), ImplicitMidpoint{}, ClosedJoints{});
}

}  // namespace delassus_run
