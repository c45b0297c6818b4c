/// A loop for links with one axis each.
#pragma once

#include "loop_of.hpp"  // before all else

#include <delassus/stabilisation/closed_joints.hpp>

namespace delassus_run {

inline auto single_axes_loop(const Asked& asked) {
  return loop_of(asked, laws_of_single_axes(asked), ClosedJoints{});
}

}  // namespace delassus_run
