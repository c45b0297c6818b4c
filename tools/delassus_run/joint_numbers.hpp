/// Where the joints of a machine are as its run begins.
#pragma once

#include "options.hpp"

#include <string>
#include <vector>

namespace delassus_run {

struct JointNumbers {
  std::vector<double> q, v;        ///< see `JointSpace`; empty: as the tree describes, at rest
  std::vector<std::string> notes;  ///< sentences that the user should read
};

/// Those of the keyframe, or of the file, and of what --at says. A joint that the file has beyond its limits is at the nearest of
/// them. Joints that follow others are where those lead them. Refuses a keyframe and joints that are not there.
JointNumbers joint_numbers(const Model& model, Base base, const Options& options);

/// The keyframe of a name; null where the options name none. Refuses one that is not there.
const model::Keyframe* keyframe(const Model& model, const Options& options);

/// Whether a coupling says where a joint is.
bool follows(const Model& model, Index joint);

/// A joint with one number.
inline bool has_number(const model::Joint& joint) { return joint.kind == model::JointKind::hinge || joint.kind == model::JointKind::slide; }
inline const char* unit_of(const model::Joint& joint) { return joint.kind == model::JointKind::hinge ? " rad" : " m"; }

}  // namespace delassus_run
