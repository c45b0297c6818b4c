/// Turns a model into bodies and constraints of a loop: all of it, or nothing.
#pragma once

#include <delassus/model/inner/add_actuators.hpp>
#include <delassus/model/inner/add_bodies.hpp>
#include <delassus/model/inner/add_couplings.hpp>
#include <delassus/model/inner/add_exclusions.hpp>
#include <delassus/model/inner/add_joints.hpp>
#include <delassus/model/inner/add_tendons.hpp>
#include <delassus/model/inner/machine_builder.hpp>

#include <algorithm>
#include <string>
#include <utility>

namespace delassus::inner {

/// Names what has no law here.
template <class Builder>
void leave_rest(Builder& builder) {
  const Model& model = builder.model();
  if (const std::size_t count = builder.machine().lifts.size(); count > 0)
    builder.leave("the weight of " + std::to_string(count) +
                  " of its bodies is taken off by actuate alone; call it before each step");
  for (const model::Joint& joint : model.joints)
    if ((joint.kind == model::JointKind::ball || joint.kind == model::JointKind::free) &&
        (joint.damping > 0 || joint.stiffness > 0 || joint.friction_loss > 0 || joint.armature > 0))
      builder.leave("spring, damping, dry friction and rotor of joint '" + joint.name +
                    "' do not act: it is a ball or free");
  if (!builder.has_contacts()) return;
  const auto any = [&](auto is_so) {
    return std::any_of(model.geometries.begin(), model.geometries.end(), is_so);
  };
  const bool leaves_surfaces = builder.leave_out().surfaces;
  if (leaves_surfaces && any([](const model::Geometry& g) {
        return g.friction != 1 || g.contact_freedoms == 1 || g.restitution != 0;
      }))
    builder.leave(
        "all contacts have the law of the loop: friction and restitution of single shapes are not used");
  if (any([](const model::Geometry& g) { return g.contact_freedoms > 3; }))
    builder.leave("contacts spin and roll as the law of the loop says, not as single shapes do");
  if (any([](const model::Geometry& g) { return norm(g.surface_velocity) + norm(g.surface_spin) > 0; }))
    builder.leave("surfaces of shapes do not run");
  if (builder.contact_kinds().are_mixed())
    builder.leave(
        "a body of several shapes meets another where the types and affinities of any of them say so");
  if (const std::size_t count = builder.contact_kinds().left_over(); count > 0)
    builder.leave(std::to_string(count) +
                  " kinds of types and affinities have no group left, and meet as type 1 and affinity 1");
  if (!model.pairs.empty())
    builder.leave("its " + std::to_string(model.pairs.size()) +
                  " contact pairs have no numbers of their own");
}

template <class Builder>
void add_all(Builder& builder) {
  add_bodies(builder);
  add_joints(builder);
  if (!builder.leave_out().couplings) add_couplings(builder);
  add_tendons(builder);
  add_actuators(builder);
  add_exclusions(builder);
  leave_rest(builder);
}

template <class Loop>
Machine add_machine(Loop& loop, const Model& model, const Lumps& lumps, const Pose& pose,
                    const LeaveOut& leave_out) {
  MachineBuilder<Loop> builder(loop, model, lumps, pose, leave_out);
  add_all(builder);
  builder.stop_looking();
  add_all(builder);
  return std::move(builder.machine());
}

}  // namespace delassus::inner
