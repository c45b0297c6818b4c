/// Where a machine is in a loop: which body each link became, and how to read its joints.
#pragma once

#include <delassus/bodies/rigid_bodies.hpp>
#include <delassus/constraints/joints/tendon.hpp>
#include <delassus/model/inner/axis_force.hpp>
#include <delassus/model/model.hpp>

#include <cstdint>
#include <string>
#include <utility>
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
  bool actuators = false;      ///< they push nothing, whatever the controls are
  bool surfaces = true;        ///< friction and restitution of single shapes: all contacts have the law of the loop
};

namespace model {

using delassus::AxisKind;

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

/// Weight that `actuate` takes off a body.
struct Lift {
  RigidBodies::Handle body{};
  double mass = 0;             ///< kg
  Vec3 moment = zero<Vec3>();  ///< Σ mass · place in the frame of the body, about its centre, kg·m
};

/// Names a constraint of some law: the numbers of its `ConstraintHandle`.
struct ConstraintNumber {
  Index index = -1;
  std::uint32_t generation = 0, owner = 0;
};

/// What an actuator shall do in the next step, found before any of them acts.
struct Order {
  double activation = 0;       ///< at the end of the step
  double force = 0;            ///< that is pushed, before the gear
  double rest = 0, speed = 0;  ///< of its law
};

/// How an actuator acts in a loop.
struct Actuation {
  enum class Law {
    none,    ///< it does not
    force,   ///< pushes, with the force of the start of a step
    spring,  ///< `SpringDamper` or `Tendon`: stiffness and damping are implicit
    motor,   ///< `Drive` or `TendonMotor`: likewise, with a cap
  };
  Law law = Law::none;
  Actuator actuator;              ///< of the model
  std::vector<TendonPart> parts;  ///< length before the gear = offset + Σ coefficient · coordinate
  double offset = 0;
  bool is_tendon = false;      ///< its law is that of tendons, of `size` parts
  int size = 0;
  ConstraintNumber constraint;
  Part site;                   ///< of an actuator on a site: its body, and its frame in it
  Order order;                 ///< of `actuate`
};

}  // namespace model

/// What `add` put into a loop.
struct Machine {
  std::vector<model::Part> parts;  ///< of each body of the model
  std::vector<model::Axis> axes;   ///< of each joint of the model; of no account for `ball` and `free`
  std::vector<model::Actuation> actuators;  ///< of each actuator of the model
  std::vector<double> controls;             ///< of each actuator: set them as you like, `actuate` reads them; at first 0
  std::vector<double> activations;          ///< what their filters have made of the controls; of no account without a filter
  std::vector<model::Lift> lifts;           ///< weight that `actuate` takes off
  /// What the model asks for and the loop does not do, a sentence each.
  std::vector<std::string> left_out;

  /// Controls, activations and the turns that servos have counted, which a checkpoint of the loop does not hold: keep them
  /// beside it by an `ArchiveWriter`, and give them to a machine of the same model by an `ArchiveReader`.
  /// What is refused leaves the machine as it is.
  void memory(auto& archive) {
    Machine read = *this;
    archive(read.controls, read.activations);
    for (model::Actuation& act : read.actuators)
      for (TendonPart& part : act.parts) archive(part.position);
    if (!archive.reads) return;
    read.expect_controls("memory");
    *this = std::move(read);
  }
  /// Refuses lists of controls and activations that have another size than the one of actuators.
  void expect_controls(const char* what) const {
    DELASSUS_EXPECT(controls.size() == actuators.size() && activations.size() == actuators.size(),
                    std::string(what) + ": the machine has " + std::to_string(controls.size()) + " controls and " +
                        std::to_string(activations.size()) + " activations; give it one of each for each of its " +
                        std::to_string(actuators.size()) + " actuators");
  }
};

/// Where a link is now.
inline Pose pose_of(const RigidBodies& set, const Machine& machine, Index body) {
  DELASSUS_EXPECT(body >= 0 && std::size_t(body) < machine.parts.size(),
                  "pose_of: this machine has no body " + std::to_string(body));
  const model::Part& part = machine.parts[std::size_t(body)];
  if (part.is_world) return part.pose;
  const Pose own{set.position(part.body), set.orientation(part.body).toRotationMatrix()};
  return {own.to_world(part.pose.position), own.rotation * part.pose.rotation};
}

namespace inner {

/// Refuses what is no hinge and no slide of the machine, one that the world holds, and one of a body that is not in this world.
template <class World>
const model::Axis& axis_of(const World& world, const Machine& machine, Index joint, const char* what) {
  DELASSUS_EXPECT(joint >= 0 && std::size_t(joint) < machine.axes.size() &&
                      !(machine.axes[std::size_t(joint)].a.is_world() && machine.axes[std::size_t(joint)].b.is_world()),
                  std::string(what) + ": joint " + std::to_string(joint) + " is no hinge or slide that moves in this machine");
  const model::Axis& axis = machine.axes[std::size_t(joint)];
  const std::string why = what_is_wrong(bodies<RigidBodies>(world), axis.a, axis.b);
  if (!why.empty()) refuse(std::string(what) + ": joint " + std::to_string(joint) + ": " + why);
  return axis;
}

}  // namespace inner

/// q of a hinge or a slide now, rad or m. A hinge is known up to whole turns: it is within half a turn of its reference.
template <class World>
double position_of(const World& world, const Machine& machine, Index joint) {
  const model::Axis& axis = inner::axis_of(world, machine, joint, "position_of");
  const double value = inner::axis_value(axis.kind, {axis.a, axis.b, world}, axis.zero);
  return axis.reference + axis.sign * (value - axis.zero);
}

/// q̇ of a hinge or a slide now, rad/s or m/s.
template <class World>
double rate_of(const World& world, const Machine& machine, Index joint) {
  const model::Axis& axis = inner::axis_of(world, machine, joint, "rate_of");
  return axis.sign * inner::rate_between(world, axis.kind, axis.a, axis.b);
}

/// Pushes a hinge or a slide with `force` (N·m or N) to larger q in the next step, as a motor between its two bodies.
template <class Loop>
void push_joint(Loop& loop, const Machine& machine, Index joint, double force) {
  inner::expect_number(std::isfinite(force), "push_joint: force", force, "must be finite");
  const model::Axis& axis = inner::axis_of(loop.world(), machine, joint, "push_joint");
  inner::push_between(loop.world(), axis.kind, axis.a, axis.b, axis.sign * force);
}

}  // namespace delassus
