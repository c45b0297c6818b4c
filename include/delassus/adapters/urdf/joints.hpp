/// The joints of a description for one joint of a URDF.
#pragma once

#include <delassus/adapters/urdf/groups.hpp>

#include <string>
#include <vector>

namespace delassus::inner::urdf_file {

inline void set_limits(const Source& in, const JointElement& element, const urdf::Joint& read,
                       model::Joint& joint) {
  if (!read.limits) return;
  const urdf::JointLimits& limits = *read.limits;
  if (limits.effort < 0 || limits.velocity < 0)
    in.refuse_at(element.line, "effort and velocity of joint '" + element.name + "' must be >= 0");
  joint.effort = limits.effort;
  joint.speed = limits.velocity;
  if (read.type == urdf::Joint::CONTINUOUS) return;
  if (limits.lower > limits.upper)
    in.refuse_at(element.line, "the limits of joint '" + element.name + "' go from " + text(limits.lower) +
                                   " to " + text(limits.upper) + "; the lower one must come first");
  joint.is_limited = true;
  joint.lower = limits.lower;
  joint.upper = limits.upper;
}

inline void set_dynamics(const Source& in, const JointElement& element, const urdf::Joint& read,
                         model::Joint& joint) {
  if (!read.dynamics) return;
  if (read.dynamics->damping < 0 || read.dynamics->friction < 0)
    in.refuse_at(element.line, "damping and friction of joint '" + element.name + "' must be >= 0");
  joint.damping = read.dynamics->damping;
  joint.friction_loss = read.dynamics->friction;
}

/// A turn or a slide is one; what moves in a plane two slides and then a turn; what is fixed none. Point and
/// axis are of the link `child`, given in the body's frame.
inline std::vector<model::Joint> joints_of(Source& in, const JointElement& element, const urdf::Joint& read,
                                           const Pose& child) {
  using model::JointKind;
  model::Joint joint{.name = element.name, .point = child.position};
  if (read.type == urdf::Joint::FIXED) return {};
  if (read.type == urdf::Joint::FLOATING || read.type == urdf::Joint::PLANAR) {
    if (read.limits)
      in.skip(element.line,
              "limits of joint '" + element.name + "', of which URDF does not say what they limit");
    if (read.dynamics)
      in.skip(element.line, "damping and friction of joint '" + element.name +
                                "', of which URDF does not say what they brake");
  }
  if (read.type == urdf::Joint::FLOATING) {
    joint.kind = JointKind::free;
    return {joint};
  }
  const Vec3 given = vector_of(read.axis);
  const double scale = std::abs(given[largest_entry(given)]);
  if (!(scale > 0)) in.refuse_at(element.line, "the axis of joint '" + element.name + "' is zero");
  const Vec3 scaled = given / scale, axis = scaled / norm(scaled);
  if (read.type == urdf::Joint::PLANAR) {
    const Vec3 across = axis == Vec3(0, 0, 1) ? Vec3(1, 0, 0) : unit_across(axis);
    std::vector<model::Joint> three(3, joint);
    const Vec3 along[] = {across, cross(axis, across), axis};
    const char* endings[] = {"_x", "_y", "_turn"};
    for (int k = 0; k < 3; ++k) {
      three[std::size_t(k)].kind = k < 2 ? JointKind::slide : JointKind::hinge;
      three[std::size_t(k)].name += endings[k];
      three[std::size_t(k)].axis = child.rotation * along[k];
    }
    return three;
  }
  joint.kind = read.type == urdf::Joint::PRISMATIC ? JointKind::slide : JointKind::hinge;
  joint.axis = child.rotation * axis;
  set_limits(in, element, read, joint);
  set_dynamics(in, element, read, joint);
  return {joint};
}

}  // namespace delassus::inner::urdf_file
