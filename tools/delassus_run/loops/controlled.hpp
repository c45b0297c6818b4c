/// A loop for joints of any kind whose steps keep an error.
#pragma once

#include "loop_of.hpp"  // before all else

#include <delassus/schemes/error_controlled.hpp>

namespace delassus_run {

inline auto controlled_loop(const Asked& asked) {
  return loop_of(asked, every_law(asked), ImplicitMidpoint{}, PositionProjection{.rate = 1},
                 ErrorControlled{.accuracy = asked.accuracy, .max_step = asked.longest_step});
}

}  // namespace delassus_run
