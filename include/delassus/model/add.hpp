/// A machine put into a loop: bodies, shapes, joints, limits, springs and couplings of a `Model`.
#pragma once

#include <delassus/model/check.hpp>
#include <delassus/model/inner/lumps.hpp>
#include <delassus/model/inner/machine_builder.hpp>
#include <delassus/model/machine.hpp>

namespace delassus {

/// Puts a model into a loop, its root at `pose`, all joints at their reference. Links that no joint parts become one body. The loop
/// names the laws that the model needs, and a compound layer where shapes are not in the middle of their bodies; what is missing is
/// refused in one sentence that lists it, and nothing is added then. The gravity of the set is not touched.
///
/// `base` holds or frees the roots, whatever the file says. Actuators act by `actuate`, see `model/actuators.hpp`. What is told by
/// `left_out` of the result does not act: actuators of ball joints, couplings that are not linear, height fields.
template <class Loop>
Machine add(Loop& loop, const Model& model, const Pose& pose = {}, Base base = Base::as_file, const LeaveOut& leave_out = {}) {
  check(model);
  const inner::Lumps lumps(model, pose, base == Base::fixed, base == Base::free);
  inner::MachineBuilder<Loop> builder(loop, model, lumps, pose, leave_out);
  builder.refuse_what_is_missing();
  return builder.made();
}

}  // namespace delassus
