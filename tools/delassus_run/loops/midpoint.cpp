// A loop for joints of any kind, its steps of second order.
#include "midpoint.hpp"  // before all else

#include "in_loop.hpp"
#include "loops.hpp"

namespace delassus_run {

std::unique_ptr<Motion> midpoint(const Model& model, const Pose& pose, Base base, const Asked& asked) {
  return std::make_unique<InLoop<midpoint_loop>>(model, pose, base, asked);
}

}  // namespace delassus_run
