// A loop for links with one axis each.
#include "single_axes.hpp"  // before all else

#include "in_loop.hpp"
#include "loops.hpp"

namespace delassus_run {

std::unique_ptr<Motion> single_axes(const Model& model, const Pose& pose, Base base, const Asked& asked) {
  return std::make_unique<InLoop<single_axes_loop>>(model, pose, base, asked);
}

}  // namespace delassus_run
