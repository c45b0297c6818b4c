/// The joints of a machine: what holds each link to its parent, and what acts on its axes.
#pragma once

#include <delassus/constraints/joints/ball_joint.hpp>
#include <delassus/constraints/joints/hinge.hpp>
#include <delassus/constraints/joints/limit.hpp>
#include <delassus/constraints/joints/motor.hpp>
#include <delassus/constraints/joints/rotation_angle.hpp>
#include <delassus/constraints/joints/rotor_inertia.hpp>
#include <delassus/constraints/joints/serial_joint.hpp>
#include <delassus/constraints/joints/slider.hpp>
#include <delassus/constraints/joints/spring_damper.hpp>
#include <delassus/model/inner/chains.hpp>
#include <delassus/model/machine.hpp>

#include <algorithm>
#include <numbers>
#include <string>

namespace delassus::inner {

template <class Builder>
void add_ball(Builder& builder, const Chain& chain) {
  const model::Body& body = builder.model().bodies[std::size_t(chain.body)];
  const model::Joint& joint = builder.model().joints[std::size_t(body.joints[0])];
  builder.speak_of("joint", joint.name);
  builder.template emit<BallJoint>("BallJoint{}", [&] {
    return BallJoint::Item{builder.end(body.parent, chain.at), builder.end(chain.body, chain.at)};
  });
  const bool can_stop = joint.is_limited && joint.upper < std::numbers::pi;  // no turn is larger
  if (can_stop && !builder.leave_out().limits)  // turned as the tree describes, its angle is 0
    builder.template emit<Limit<RotationAngle>>("Limit<RotationAngle>{}", [&] {
      return Limit<RotationAngle>::Item{.a = builder.end(body.parent, chain.at),
                                        .b = builder.end(chain.body, chain.at),
                                        .upper = joint.upper};
    });
}

/// The law has its numbers of slides and hinges in its type.
template <class Builder>
void add_serial(Builder& builder, const Chain& chain, const Anchor& a, const Anchor& b, const Quat& frame) {
  const auto one = [&]<int s, int h>() {
    if (int(chain.slides.size()) != s || int(chain.hinges.size()) != h) return;
    const std::string name = "SerialJoint<" + std::to_string(s) + ", " + std::to_string(h) + ">{}";
    builder.template emit<SerialJoint<s, h>>(name.c_str(), [&] {
      const Vec3 slide = s == 1   ? chain.slide(0)
                         : s == 2 ? cross(chain.slide(0), chain.slide(1))
                                  : unit_axis(2);
      return typename SerialJoint<s, h>::Item{
          .a = a, .b = b, .slide = frame.conjugate() * slide, .cosine = chain.cosine, .offset = chain.offset};
    });
  };
  one.template operator()<0, 2>(), one.template operator()<0, 3>(), one.template operator()<1, 1>();
  one.template operator()<1, 2>(), one.template operator()<1, 3>(), one.template operator()<2, 0>();
  one.template operator()<2, 1>(), one.template operator()<2, 2>(), one.template operator()<2, 3>();
  one.template operator()<3, 0>(), one.template operator()<3, 1>(), one.template operator()<3, 2>();
}

/// Limit, spring and damper, rotor and dry friction of one axis.
template <class C, class Builder>
void add_laws(Builder& builder, const std::string& name, const model::Joint& joint, const model::Axis& axis) {
  const LeaveOut& leave_out = builder.leave_out();
  const auto call = [&](const char* law) { return std::string(law) + "<" + name + ">{}"; };
  if (joint.is_limited && !leave_out.limits)
    builder.template emit<Limit<C>>(call("Limit").c_str(), [&] {
      const double one = axis.coordinate(joint.lower), other = axis.coordinate(joint.upper);
      return typename Limit<C>::Item{.a = axis.a,
                                     .b = axis.b,
                                     .lower = std::min(one, other),
                                     .upper = std::max(one, other),
                                     .position = axis.zero};
    });
  const double stiffness = leave_out.springs ? 0 : joint.stiffness,
               damping = leave_out.damping ? 0 : joint.damping;
  if (stiffness > 0 || damping > 0)
    builder.template emit<SpringDamper<C>>(call("SpringDamper").c_str(), [&] {
      return typename SpringDamper<C>::Item{.a = axis.a,
                                            .b = axis.b,
                                            .rest = axis.coordinate(joint.spring_reference),
                                            .stiffness = stiffness,
                                            .damping = damping,
                                            .position = axis.zero};
    });
  if (joint.armature > 0 && !leave_out.rotors)
    builder.template emit<RotorInertia<C>>(call("RotorInertia").c_str(), [&] {
      return typename RotorInertia<C>::Item{.a = axis.a, .b = axis.b, .inertia = joint.armature};
    });
  if (joint.friction_loss > 0 && !leave_out.friction_loss)
    builder.template emit<Motor<C>>(call("Motor").c_str(), [&] {
      return typename Motor<C>::Item{
          .a = axis.a, .b = axis.b, .max_force = joint.friction_loss, .position = axis.zero};
    });
}

template <class Builder>
void add_axis(Builder& builder, Index j, model::Axis axis) {
  const model::Joint& joint = builder.model().joints[std::size_t(j)];
  model::Axis& kept = builder.machine().axes[std::size_t(j)];
  builder.speak_of("joint", joint.name);
  axis.reference = joint.reference;
  if (!builder.is_looking()) {
    const auto& world = builder.loop().world();
    world.resolve(axis.a, "add"), world.resolve(axis.b, "add");
    kept = axis;
    axis.zero = axis.sign * (position_of(world, builder.machine(), j) - axis.reference);
  }
  kept = axis;
  if (axis.kind == AxisKind::length) return;  // of tendons alone
  with_axis(axis.kind, [&]<class C>() { add_laws<C>(builder, name_of(axis.kind), joint, axis); });
}

template <class Builder>
void add_chain(Builder& builder, const Chain& chain) {
  if (chain.is_ball) return add_ball(builder, chain);
  if (chain.is_free || chain.axes.empty()) return;
  const Index parent = builder.model().bodies[std::size_t(chain.body)].parent, body = chain.body;
  const std::size_t slides = chain.slides.size(), hinges = chain.hinges.size();
  const Quat first = along(hinges > 0 ? chain.hinge(0) : chain.slide(0)),
             last = hinges > 0 ? along(chain.hinge(hinges - 1)) : first;
  const Anchor a = builder.end(parent, chain.at, first),
               b = builder.end(body, hinges == 2 ? chain.at_last : chain.at, hinges == 1 ? first : last);
  builder.speak_of("body", builder.model().bodies[std::size_t(body)].name);
  if (slides == 0 && hinges == 1)
    builder.template emit<Hinge>("Hinge{}", [&] { return Hinge::Item{a, b}; });
  else if (slides == 1 && hinges == 0)
    builder.template emit<Slider>("Slider{}", [&] { return Slider::Item{a, b}; });
  else
    add_serial(builder, chain, a, b, first);

  for (std::size_t k = 0; k < slides; ++k) {
    const Quat frame = along(chain.slide(k));
    add_axis(builder, chain.slides[k],
             {.kind = AxisKind::slide,
              .a = builder.end(parent, chain.at, frame),
              .b = builder.end(body, chain.at, frame)});
  }
  for (std::size_t k = 0; k < hinges; ++k) {
    const auto kind = hinges == 1       ? AxisKind::turn
                      : k == 0          ? AxisKind::precession
                      : k + 1 == hinges ? AxisKind::spin
                                        : AxisKind::nutation;
    const bool runs_backwards =
        kind == AxisKind::nutation && dot(chain.hinge(1), cross(chain.hinge(0), chain.hinge(2))) < 0;
    add_axis(builder, chain.hinges[k], {.kind = kind, .a = a, .b = b, .sign = runs_backwards ? -1. : 1.});
  }
}

template <class Builder>
void add_joints(Builder& builder) {
  builder.machine().axes.resize(builder.model().joints.size());
  for (const Chain& chain : builder.chains()) add_chain(builder, chain);
}

}  // namespace delassus::inner
