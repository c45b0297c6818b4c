/// The types of loops that delassus_run has, each compiled in a file of its own: few, since each takes long.
#pragma once

#include "../motion.hpp"

namespace delassus_run {

/// Links with one axis each, `SymplecticEuler`.
std::unique_ptr<Motion> single_axes(const Model& model, const Pose& pose, Base base, const Asked& asked);
/// Every law, `SymplecticEuler`.
std::unique_ptr<Motion> every_joint(const Model& model, const Pose& pose, Base base, const Asked& asked);
/// Every law, `ImplicitMidpoint`.
std::unique_ptr<Motion> midpoint(const Model& model, const Pose& pose, Base base, const Asked& asked);
/// Every law, `ImplicitMidpoint` and `ErrorControlled`.
std::unique_ptr<Motion> controlled(const Model& model, const Pose& pose, Base base, const Asked& asked);

}  // namespace delassus_run
