/// A machine put into a loop: bodies, shapes, joints, limits, springs and couplings of a `Model`.
#pragma once

#include <delassus/model/check.hpp>
#include <delassus/model/inner/add_machine.hpp>
#include <delassus/model/inner/lumps.hpp>
#include <delassus/model/machine.hpp>

namespace delassus {

/// Puts a model into a loop, its root at `pose`, all joints at their reference. Links that no joint parts
/// become one body. The loop names the laws that the model needs, and a compound layer where shapes are not
/// in the middle of their bodies; what is missing is refused in one sentence that lists it. So is what a law
/// or a body does not take, by the name of the element. Nothing is added then. The gravity of the set is not
/// touched.
///
/// `base` holds or frees the roots, whatever the file says. Actuators act by `actuate`, and so does weight
/// that is taken off, see `model/actuators.hpp`. Shapes meet by their types and affinities; bodies of the
/// loop and of other machines count as 1 and 1 among them. Contact pairs meet whatever their types say, unless
/// a joint or an exclusion parts their bodies. Friction and restitution of single shapes act
/// where `leave_out.surfaces` is false, as materials of their bodies. Height fields and triangles of the
/// world act with `WithMeshes`. What is told by `left_out` of the result does not act: actuators of ball
/// joints, couplings that are not linear.
template <class Loop>
Machine add(Loop& loop, const Model& model, const Pose& pose = {}, Base base = Base::as_file,
            const LeaveOut& leave_out = {}) {
  check(model);
  const inner::Lumps lumps(model, pose, base == Base::fixed, base == Base::free);
  return inner::add_machine(loop, model, lumps, pose, leave_out);
}

}  // namespace delassus
