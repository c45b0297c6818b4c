// A loop for joints of any kind whose steps keep an error.
#include "in_loop.hpp"
#include "loops.hpp"

#include <delassus/schemes/error_controlled.hpp>

namespace delassus_run {

std::unique_ptr<Motion> controlled(const Model& model, const Pose& pose, Base base, const Asked& asked) {
  return in_loop(model, pose, base, asked, every_law(asked), ImplicitMidpoint{}, PositionProjection{.rate = 1},
                 ErrorControlled{.accuracy = asked.accuracy, .max_step = asked.longest_step});
}

}  // namespace delassus_run
