/// Whether the bodies and joints of a description make a tree that can move.
#pragma once

#include <delassus/model/inner/check_numbers.hpp>

#include <vector>

namespace delassus::inner {

inline void check_joints(const Model& model) {
  using model::JointKind;
  check_each(model, "joint", model.joints, [](const model::Joint& joint, const ModelElement& who) {
    who.expect_sane(joint.point, "its point");
    who.expect_sane(joint.axis, "its axis");
    if (joint.kind == JointKind::hinge || joint.kind == JointKind::slide)
      who.expect(std::abs(norm(joint.axis) - 1) <= 1e-9, "its axis is no unit vector");
    who.expect_sane(joint.reference, "its reference");
    if (joint.is_limited) who.expect_range(joint.lower, joint.upper, "its limits");
    who.expect(!joint.is_limited || joint.kind != JointKind::free, "a free joint has no limits");
    who.expect_at_least_zero(joint.damping, "damping");
    who.expect_at_least_zero(joint.friction_loss, "friction loss");
    who.expect_at_least_zero(joint.stiffness, "stiffness");
    who.expect_sane(joint.spring_reference, "the reference of its spring");
    who.expect_at_least_zero(joint.armature, "armature");
    who.expect_at_least_zero(joint.effort, "effort");
    who.expect_at_least_zero(joint.speed, "speed");
  });
}

/// Each joint is of one body, and a free one is its only one.
inline void check_owners(const Model& model) {
  std::vector<Index> owner(model.joints.size(), -1);
  check_each(model, "body", model.bodies, [&](const model::Body& body, const ModelElement& who) {
    for (const Index j : body.joints) {
      who.expect_index(j, model.joints.size(), "the index of a joint");
      who.expect(owner[std::size_t(j)] < 0, "one of its joints is of another body too, or twice its own");
      owner[std::size_t(j)] = who.index;
      who.expect(model.joints[std::size_t(j)].kind != model::JointKind::free || body.joints.size() == 1,
                 "a free joint must be the only one of its body");
    }
  });
  check_each(model, "joint", model.joints, [&](const model::Joint&, const ModelElement& who) {
    who.expect(owner[std::size_t(who.index)] >= 0, "it is of no body");
  });
}

/// Parents come first. What a joint moves has mass: its body, or one that is fixed to it.
inline void check_bodies(const Model& model) {
  std::vector<double> carried(model.bodies.size(), 0.0);
  check_each(model, "body", model.bodies, [&](const model::Body& body, const ModelElement& who) {
    who.expect(body.parent >= -1 && body.parent < who.index,
               "its parent must stand before it in the list, or be -1, the world");
    who.expect_pose(body.pose);
    who.expect_at_least_zero(body.mass, "mass");
    who.expect_sane(body.centre, "its centre of mass");
    who.expect_sane(body.inertia, "its inertia");
    const Mat3& I = body.inertia;
    const double size = std::max(std::max(std::abs(I(0, 0)), std::abs(I(1, 1))), std::abs(I(2, 2)));
    who.expect(std::max(std::max(std::abs(I(0, 1) - I(1, 0)), std::abs(I(1, 2) - I(2, 1))),
                        std::abs(I(2, 0) - I(0, 2))) <= 1e-9 * size,
               "its inertia is not symmetric");
    who.expect_sane(body.gravity_compensation, "gravity compensation");
    carried[std::size_t(who.index)] = body.mass;
  });
  for (std::size_t i = model.bodies.size(); i-- > 0;) {
    const model::Body& body = model.bodies[i];
    if (body.joints.empty()) {
      if (body.parent >= 0) carried[std::size_t(body.parent)] += carried[i];
    } else {
      ModelElement{model, "body", Index(i), body.name}.expect(
          carried[i] > 0 || body.is_kinematic,
          "a joint moves it, and neither it nor what is fixed to it has mass; give it some, or fix it");
    }
  }
}

}  // namespace delassus::inner
