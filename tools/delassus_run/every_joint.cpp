// A loop for joints of any kind.
#include "in_loop.hpp"
#include "loops.hpp"

#include <delassus/stabilisation/closed_joints.hpp>

namespace delassus_run {

std::unique_ptr<Motion> every_joint(const Model& model, const Pose& pose, Base base, const Asked& asked) {
  return in_loop(model, pose, base, asked, every_law(asked), ClosedJoints{});
}

}  // namespace delassus_run
