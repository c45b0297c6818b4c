// A loop for joints of any kind whose steps keep an error.
#include "controlled.hpp"  // before all else

#include "in_loop.hpp"
#include "loops.hpp"

namespace delassus_run {

std::unique_ptr<Motion> controlled(const Model& model, const Pose& pose, Base base, const Asked& asked) {
  return std::make_unique<InLoop<controlled_loop>>(model, pose, base, asked);
}

}  // namespace delassus_run
