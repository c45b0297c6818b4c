/// Where a machine is in a loop: which body each link became, and how to read its joints.
#pragma once

#include <delassus/bodies/rigid_bodies.hpp>
#include <delassus/constraints/joints/coordinate.hpp>
#include <delassus/constraints/joints/euler_angles.hpp>
#include <delassus/constraints/joints/rotor_inertia.hpp>
#include <delassus/model/model.hpp>

#include <string>
#include <vector>

namespace delassus {

/// What of a `Model` `add` leaves out.
struct LeaveOut {
  bool contacts = false;       ///< shapes of bodies that move, and of the world
  bool limits = false;         ///< of joints and of tendons
  bool damping = false;        ///< of joints and of tendons
  bool springs = false;        ///< the same
  bool friction_loss = false;  ///< dry friction of joints
  bool couplings = false;      ///< between joints, points and bodies
  bool rotors = false;         ///< inertia of what turns with a joint
};

namespace model {

/// The coordinate that a joint's axis is, by its law's name.
enum class AxisKind { turn, slide, precession, nutation, spin };

/// One axis of a joint in a loop: q = reference + sign · (coordinate − zero).
struct Axis {
  AxisKind kind = AxisKind::turn;
  Anchor a{}, b{};       ///< the ends between which the coordinate is
  double sign = 1;       ///< −1: the coordinate runs backwards
  double zero = 0;       ///< of the coordinate, in the pose that the tree describes
  double reference = 0;  ///< q there
  /// The coordinate at which the joint is at q, near that pose.
  double coordinate(double q) const { return zero + sign * (q - reference); }
};

/// What a link became: a body of the loop, or part of the world.
struct Part {
  RigidBodies::Handle body{};  ///< of no account where `is_world`
  bool is_world = false;
  Pose pose;  ///< of the link's frame in that of the body, or in the world
};

}  // namespace model

/// What `add` put into a loop.
struct Machine {
  std::vector<model::Part> parts;  ///< of each body of the model
  std::vector<model::Axis> axes;   ///< of each joint of the model; of no account for `ball` and `free`
  /// What the model asks for and the loop does not do, a sentence each.
  std::vector<std::string> left_out;
};

/// Where a link is now.
inline Pose pose_of(const RigidBodies& set, const Machine& machine, Index body) {
  const model::Part& part = machine.parts[std::size_t(body)];
  if (part.is_world) return part.pose;
  const Pose own{set.position(part.body), set.orientation(part.body).toRotationMatrix()};
  return {own.to_world(part.pose.position), own.rotation * part.pose.rotation};
}

namespace inner {

/// Refuses what is no hinge and no slide of the machine, or one that the world holds.
inline const model::Axis& axis_of(const Machine& machine, Index joint, const char* what) {
  DELASSUS_EXPECT(joint >= 0 && std::size_t(joint) < machine.axes.size() &&
                      !(machine.axes[std::size_t(joint)].a.is_world() && machine.axes[std::size_t(joint)].b.is_world()),
                  std::string(what) + ": joint " + std::to_string(joint) + " is no hinge or slide that moves in this machine");
  return machine.axes[std::size_t(joint)];
}

}  // namespace inner

/// q of a hinge or a slide now, rad or m. A hinge is known up to whole turns: it is within half a turn of its reference.
template <class World>
double position_of(const World& world, const Machine& machine, Index joint) {
  const model::Axis& axis = inner::axis_of(machine, joint, "position_of");
  const JointFrames frames(axis.a, axis.b, world);
  double value = 0;
  switch (axis.kind) {
    case model::AxisKind::turn: value = inner::unwound<Turn>(Turn::value(frames), axis.zero); break;
    case model::AxisKind::slide: value = Slide::value(frames); break;
    case model::AxisKind::precession: value = inner::unwound<Precession>(Precession::value(frames), axis.zero); break;
    case model::AxisKind::nutation: value = Nutation::value(frames); break;
    case model::AxisKind::spin: value = inner::unwound<Spin>(Spin::value(frames), axis.zero); break;
  }
  return axis.reference + axis.sign * (value - axis.zero);
}

/// Pushes a hinge or a slide with `force` (N·m or N) to larger q in the next step, as a motor between its two bodies.
template <class Loop>
void push_joint(Loop& loop, const Machine& machine, Index joint, double force) {
  const model::Axis& axis = inner::axis_of(machine, joint, "push_joint");
  inner::CoordinateGradient gradient(JointFrames(axis.a, axis.b, loop.world()));
  switch (axis.kind) {
    case model::AxisKind::turn: Turn::write(gradient, 0, 1); break;
    case model::AxisKind::slide: Slide::write(gradient, 0, 1); break;
    case model::AxisKind::precession: Precession::write(gradient, 0, 1); break;
    case model::AxisKind::nutation: Nutation::write(gradient, 0, 1); break;
    case model::AxisKind::spin: Spin::write(gradient, 0, 1); break;
  }
  auto& set = bodies<RigidBodies>(loop.world());
  const auto push = [&](const Anchor& end, double by) {
    if (end.is_world() || !set.moves(end.block)) return;
    const RigidBodies::Handle body = set.handle(end.block);
    set.apply_force(body, by * gradient.linear, gradient.xb);
    set.apply_torque(body, by * gradient.angular);
  };
  push(axis.b, axis.sign * force);
  push(axis.a, -axis.sign * force);
}

}  // namespace delassus
