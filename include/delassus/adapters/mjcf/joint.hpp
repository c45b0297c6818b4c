/// Joints.
#pragma once

#include <delassus/adapters/mjcf/limits.hpp>
#include <delassus/model/model.hpp>

#include <array>
#include <string>

namespace delassus::inner::mjcf {

/// What `joint` says, in the units of the file.
struct JointSpec {
  int type = 3;  ///< of free, ball, slide, hinge
  Vec3 position = zero<Vec3>(), axis = {0, 0, 1};
  Limit limit, force;
  double stiffness = 0, damping = 0, friction_loss = 0, armature = 0, reference = 0, spring_reference = 0;
};

inline void read(const Element& e, JointSpec& s, Skipped& skipped) {
  if (const int k = e.choice("type", {"free", "ball", "slide", "hinge"}); k >= 0) s.type = k;
  e.read("pos", s.position);
  e.read("axis", s.axis);
  read_limit(e, "", s.limit);
  read_limit(e, "actuatorfrc", s.force);
  read_polynomial(e, "stiffness", s.stiffness, skipped);
  read_polynomial(e, "damping", s.damping, skipped);
  e.read("frictionloss", s.friction_loss);
  e.read("armature", s.armature);
  e.read("ref", s.reference);
  e.read("springref", s.spring_reference);
  skip_number(e, "margin", "a limit acts where it is reached", skipped);
  skip_number(e, "springdamper", "give stiffness and damping instead", skipped);
  bool is_on = false;
  if (e.read("actuatorgravcomp", is_on) && is_on)
    skipped.add(e, "actuatorgravcomp: the compensation of gravity is no force of an actuator");
  skip_softness(e, skipped);
}

/// The joint in its body's frame, in which `frame` is where the element stands.
inline model::Joint make_joint(const Element& e, const JointSpec& s, const Compiler& c, const Pose& frame,
                               Skipped& skipped) {
  using enum model::JointKind;
  constexpr model::JointKind kinds[] = {free, ball, slide, hinge};
  model::Joint joint{.kind = kinds[s.type]};
  const bool is_scalar = joint.kind == hinge || joint.kind == slide;
  const double unit = joint.kind == hinge || joint.kind == ball ? c.angle : 1;
  if (joint.kind != free) joint.point = frame.to_world(s.position);
  if (is_scalar) {
    if (!(norm(s.axis) > 1e-14)) e.refuse("the axis of the joint is too short to be a direction");
    joint.axis = direction_of(Vec3(frame.rotation * direction_of(s.axis)));
    joint.reference = s.reference * (joint.kind == hinge ? c.angle : 1);
    joint.spring_reference = s.spring_reference * (joint.kind == hinge ? c.angle : 1);
  }
  if (joint.kind != free && holds(e, c, s.limit, "")) {
    if (joint.kind == ball && s.limit.range[0] != 0) e.refuse("the range of a ball joint must begin at 0");
    joint.is_limited = true;
    joint.lower = s.limit.range[0] * unit;
    joint.upper = s.limit.range[1] * unit;
  }
  if (is_scalar && holds(e, c, s.force, "actuatorfrc")) {
    if (s.force.range[0] != -s.force.range[1])
      skipped.add(
          e, "actuatorfrcrange: the two bounds differ in size, so that it is no largest force of the joint");
    else
      joint.effort = s.force.range[1];
  }
  joint.stiffness = s.stiffness;
  joint.damping = s.damping;
  joint.friction_loss = s.friction_loss;
  joint.armature = s.armature;
  for (const auto& [attribute, value] : {std::pair{"stiffness", s.stiffness},
                                         {"damping", s.damping},
                                         {"frictionloss", s.friction_loss},
                                         {"armature", s.armature}})
    expect_not_below_zero(e, attribute, value);
  return joint;
}

/// How many numbers q and v of a joint have.
inline int q_size(const model::Joint& j) {
  return j.kind == model::JointKind::free ? 7 : j.kind == model::JointKind::ball ? 4 : 1;
}
inline int v_size(const model::Joint& j) {
  return j.kind == model::JointKind::free ? 6 : j.kind == model::JointKind::ball ? 3 : 1;
}

}  // namespace delassus::inner::mjcf
