// A loop for links with one axis each.
#include "in_loop.hpp"
#include "loops.hpp"

#include <delassus/stabilisation/closed_joints.hpp>

namespace delassus_run {

std::unique_ptr<Motion> single_axes(const Model& model, const Pose& pose, Base base, const Asked& asked) {
  return in_loop(model, pose, base, asked, laws_of_single_axes(asked), ClosedJoints{});
}

}  // namespace delassus_run
