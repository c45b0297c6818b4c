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

/// Names the contact pairs whose bodies never meet, since a joint or an exclusion parts them.
template <class Builder>
void leave_parted_pairs(Builder& builder) {
  const Model& model = builder.model();
  const auto lump_of = [&](Index geometry) {
    const Index body = model.geometries[std::size_t(geometry)].body;
    return body < 0 ? 0 : builder.lumps().of[std::size_t(body)];
  };
  const auto parent_of = [&](Index lump) {
    const Index parent = model.bodies[std::size_t(builder.lumps().all[std::size_t(lump)].root)].parent;
    return parent < 0 ? 0 : builder.lumps().of[std::size_t(parent)];
  };
  const auto is_excluded = [&](Index one, Index other) {
    return std::any_of(model.excludes.begin(), model.excludes.end(), [&](const model::Exclude& e) {
      const Index a = e.body < 0 ? 0 : builder.lumps().of[std::size_t(e.body)];
      const Index b = e.other < 0 ? 0 : builder.lumps().of[std::size_t(e.other)];
      return (a == one && b == other) || (a == other && b == one);
    });
  };
  for (const model::Pair& pair : model.pairs) {
    const Index a = lump_of(pair.geometry), b = lump_of(pair.other);
    const bool are_joined =
        !model.parents_collide && a > 0 && b > 0 && (parent_of(a) == b || parent_of(b) == a);
    if (are_joined || a == b || is_excluded(a, b))
      builder.leave("the contact pair of geometries '" + model.geometries[std::size_t(pair.geometry)].name +
                    "' and '" + model.geometries[std::size_t(pair.other)].name +
                    "' does not act: their bodies are one, joined or excluded");
  }
}

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
  if (any([](const model::Geometry& g) { return g.contact_freedoms > 3; }) ||
      std::any_of(model.pairs.begin(), model.pairs.end(),
                  [](const model::Pair& p) { return p.contact_freedoms > 3; }))
    builder.leave("contacts spin and roll as the law of the loop says, not as single shapes do");
  if (any([](const model::Geometry& g) { return norm(g.surface_velocity) + norm(g.surface_spin) > 0; }))
    builder.leave("surfaces of shapes do not run");
  if (builder.contact_kinds().are_mixed())
    builder.leave(
        "a body of several shapes meets another where the types and affinities of any of them say so");
  if (const std::size_t count = builder.contact_kinds().left_over(); count > 0)
    builder.leave(std::to_string(count) +
                  " kinds of types and affinities have no group left, and meet as type 1 and affinity 1");
  if (leaves_surfaces && !model.pairs.empty())
    builder.leave("its " + std::to_string(model.pairs.size()) +
                  " contact pairs have the friction of the loop's law");
  leave_parted_pairs(builder);
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
