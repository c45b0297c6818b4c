/// The bodies of a machine in a loop, from the numbers of its joints.
#pragma once

#include <delassus/bodies/world.hpp>
#include <delassus/math/rotation.hpp>
#include <delassus/math/twist.hpp>
#include <delassus/model/joint_space.hpp>
#include <delassus/model/machine.hpp>

#include <span>
#include <vector>

namespace delassus {

/// Places all bodies of the machine where q says, with the velocities that v says: see `JointSpace`, which was made with the same model,
/// base and pose as the machine. Angles that limits and springs count over whole turns are taken for those within half a turn of the
/// reference. Kinematic bodies stay.
template <class Loop>
void set_joint_state(Loop& loop, const Machine& machine, JointSpace& space, std::span<const double> q, std::span<const double> v) {
  auto& set = bodies<RigidBodies>(loop.world());
  std::vector<Pose> poses(machine.parts.size());
  std::vector<Vec<6>> velocities(machine.parts.size());
  space.poses(q, poses);
  space.velocities(q, v, velocities);
  for (std::size_t b = 0; b < machine.parts.size(); ++b) {
    const model::Part& part = machine.parts[b];
    if (part.is_world || !set.moves(part.body.index)) continue;
    const Mat3 turn = poses[b].rotation * part.pose.rotation.transpose();
    const Vec3 centre = poses[b].position - turn * part.pose.position;
    set.place(part.body, centre, unit(Quat(turn)));
    const Vec3 spin = angular_part(velocities[b]);
    set.set_velocity(part.body, linear_part(velocities[b]) + cross(spin, Vec3(centre - poses[b].position)), spin);
  }
}

}  // namespace delassus
