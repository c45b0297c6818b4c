/// A coordinate of two ends seen from their bodies: its rate, and a force along it.
#pragma once

#include <delassus/bodies/rigid_bodies.hpp>
#include <delassus/bodies/world.hpp>
#include <delassus/constraints/joints/any_axis.hpp>
#include <delassus/constraints/joints/rotor_inertia.hpp>
#include <delassus/math/rotation.hpp>

#include <string>

namespace delassus::inner {

/// The body of an end that is on one.
inline RigidBodies::Handle body_of(const Anchor& end) { return {end.block, end.generation, end.owner}; }

/// What is wrong with a body of a machine in this set: nothing, or the rest of a sentence.
inline std::string what_is_wrong(const RigidBodies& set, const RigidBodies::Handle& body) {
  if (set.contains(body)) return {};
  if (body.owner == set.owner()) return set.who(body.index) + " of this machine was removed";
  return "this loop does not have the bodies of this machine; put it there by add";
}
/// The same of two ends.
inline std::string what_is_wrong(const RigidBodies& set, const Anchor& a, const Anchor& b) {
  std::string why;
  for (const Anchor* end : {&a, &b})
    if (why.empty() && !end->is_world()) why = what_is_wrong(set, body_of(*end));
  return why;
}

/// Where ends will be in `seconds` if the rigid bodies that hold them keep their velocities.
template <class World>
class WorldAhead {
 public:
  WorldAhead(const World& world, double seconds)
      : world_(world), set_(bodies<RigidBodies>(world)), seconds_(seconds) {}

  Vec3 point(const Anchor& a) const {
    if (a.is_world()) return world_.point(a);
    return centre(a) + turned(a) * Vec3(world_.point(a) - set_.position(body_of(a)));
  }
  Mat3 axes(const Anchor& a) const {
    return a.is_world() ? world_.axes(a) : Mat3(turned(a) * world_.axes(a));
  }
  /// Of mass, of the body of an end.
  Vec3 centre(const Anchor& a) const {
    const auto body = body_of(a);
    return set_.position(body) + seconds_ * set_.velocity(body);
  }

 private:
  Mat3 turned(const Anchor& a) const {
    return rotation_matrix(exponential<double>(seconds_ * set_.angular_velocity(body_of(a))));
  }
  const World& world_;
  const RigidBodies& set_;
  const double seconds_;
};

inline CoordinateGradient gradient_of(AxisKind kind, const JointFrames& frames) {
  CoordinateGradient gradient(frames);
  write_axis(kind, gradient, 0, 1);
  return gradient;
}

/// q̇ of the coordinate between two ends now, whose bodies are there.
template <class World>
double rate_between(const World& world, AxisKind kind, const Anchor& a, const Anchor& b) {
  const RigidBodies& set = bodies<RigidBodies>(world);
  const CoordinateGradient gradient = gradient_of(kind, {a, b, world});
  double rate = 0;
  const auto add = [&](const Anchor& end, double sign) {
    if (end.is_world()) return;
    const auto body = body_of(end);
    const Vec3 spin = set.angular_velocity(body),
               v = set.velocity(body) + cross(spin, Vec3(gradient.xb - set.position(body)));
    rate += sign * (dot(gradient.linear, v) + dot(gradient.angular, spin));
  };
  add(b, 1), add(a, -1);
  return rate;
}

/// Pushes the coordinate with `force` to larger values in the next step: along the axis as it will be in
/// `ahead` s.
template <class World>
void push_between(World& world, AxisKind kind, const Anchor& a, const Anchor& b, double force,
                  double ahead = 0) {
  RigidBodies& set = bodies<RigidBodies>(world);
  const WorldAhead<World> then(world, ahead);
  const CoordinateGradient gradient = gradient_of(kind, {a, b, then});
  const auto push = [&](const Anchor& end, double by) {
    if (end.is_world() || !set.moves(end.block)) return;
    const auto body = body_of(end);
    const Vec3 linear = by * gradient.linear;
    set.apply_force(body, linear);
    set.apply_torque(body, by * gradient.angular + cross(Vec3(gradient.xb - then.centre(end)), linear));
  };
  push(b, force), push(a, -force);
}

}  // namespace delassus::inner
