/// Weight that a model takes off its bodies.
#pragma once

#include <delassus/math/rotation.hpp>
#include <delassus/model/inner/lumps.hpp>
#include <delassus/model/machine.hpp>

#include <cstddef>
#include <string>

namespace delassus::inner {

/// Of lump l, whose body of the loop has its frame at `own` in the root.
inline model::Lift lift_of(const Model& model, const Lumps& lumps, std::size_t l, const Pose& own) {
  model::Lift lift;
  for (std::size_t b = 0; b < model.bodies.size(); ++b) {
    const model::Body& body = model.bodies[b];
    if (lumps.of[b] != Index(l) || body.gravity_compensation == 0) continue;
    const double mass = body.gravity_compensation * body.mass;
    const Vec3 centre = lumps.in_root[b].to_world(body.centre);
    lift.mass += mass;
    lift.moment += mass * transposed_times(own.rotation, Vec3(centre - own.position));
  }
  return lift;
}

inline void expect_lifts(const RigidBodies& set, const Machine& machine, const char* what) {
  for (const model::Lift& lift : machine.lifts)
    if (const std::string why = what_is_wrong(set, lift.body); !why.empty())
      refuse(std::string(what) + ": a body whose weight is taken off: " + why);
}

/// −g times the masses, where they are halfway through a step of h.
inline void push_up(RigidBodies& set, const Machine& machine, double h) {
  for (const model::Lift& lift : machine.lifts) {
    if (!set.moves(lift.body.index)) continue;
    const Vec3 up = -set.gravity;
    const Quat turn = exponential<double>(Vec3(h / 2 * set.angular_velocity(lift.body)));
    const Vec3 moment = rotation_matrix(turn * set.orientation(lift.body)) * lift.moment;
    set.apply_force(lift.body, lift.mass * up);
    set.apply_torque(lift.body, cross(moment, up));
  }
}

}  // namespace delassus::inner
