/// A loop for joints of any kind.
#pragma once

#include "loop_of.hpp"  // before all else

#include <delassus/stabilisation/closed_joints.hpp>

namespace delassus_run {

inline auto every_joint_loop(const Asked& asked) {
  return loop_of(asked, every_law(asked), ClosedJoints{});
}

}  // namespace delassus_run
