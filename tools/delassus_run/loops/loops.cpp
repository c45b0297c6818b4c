// Which of the types of loops a model and its user need.
#include "loops.hpp"

#include <delassus/study/code_of.hpp>

namespace delassus_run {

namespace {

/// What `laws_of_single_axes` has is enough.
bool has_single_axes(const Model& model) {
  if (!model.couplings.empty() || !model.connects.empty() || !model.welds.empty() || !model.tendons.empty()) return false;
  for (const model::Body& body : model.bodies) {
    if (body.joints.size() > 1) return false;
    for (const Index j : body.joints)
      if (model.joints[std::size_t(j)].kind == model::JointKind::ball) return false;
  }
  return true;
}

}  // namespace

std::unique_ptr<Motion> moved(const Model& model, const Pose& pose, Base base, const Asked& asked) {
  if (asked.accuracy > 0) return controlled(model, pose, base, asked);
  if (asked.integration == Integration::midpoint) return midpoint(model, pose, base, asked);
  return has_single_axes(model) ? single_axes(model, pose, base, asked) : every_joint(model, pose, base, asked);
}

std::string name_of(const Model& model, const Asked& asked) {
  const std::string laws = asked.accuracy > 0 || asked.integration == Integration::midpoint || !has_single_axes(model) ? "every law of joints" : "laws of single axes";
  const std::string scheme = asked.accuracy > 0 ? "ImplicitMidpoint{}, ErrorControlled{.accuracy = " + inner::number_text(asked.accuracy, 3) + "}"
                             : asked.integration == Integration::midpoint ? "ImplicitMidpoint{}"
                                                                          : "SymplecticEuler{}";
  return laws + ", " + scheme + ", DirectGaussSeidel{.tolerance = " + inner::number_text(asked.tolerance, 3) + "}";
}

}  // namespace delassus_run
