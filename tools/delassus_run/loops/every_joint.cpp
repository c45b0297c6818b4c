// A loop for joints of any kind.
#include "every_joint.hpp"  // before all else

#include "in_loop.hpp"
#include "loops.hpp"

namespace delassus_run {

std::unique_ptr<Motion> every_joint(const Model& model, const Pose& pose, Base base, const Asked& asked) {
  return std::make_unique<InLoop<every_joint_loop>>(model, pose, base, asked);
}

}  // namespace delassus_run
