/// The bodies of a machine in a loop, from the numbers of its joints.
#pragma once

#include <delassus/bodies/world.hpp>
#include <delassus/constraints/joints/coupling.hpp>
#include <delassus/math/rotation.hpp>
#include <delassus/math/twist.hpp>
#include <delassus/model/inner/count_turns.hpp>
#include <delassus/model/inner/each_rotor.hpp>
#include <delassus/model/joint_space.hpp>
#include <delassus/model/machine.hpp>

#include <span>
#include <string>
#include <utility>
#include <vector>

namespace delassus {

namespace inner {

/// Places the bodies, and tells the laws the turns of q.
template <class Loop>
KnownTurns place_joints(Loop& loop, const Machine& machine, JointSpace& space, std::span<const double> q,
                        std::span<const double> v) {
  auto& set = bodies<RigidBodies>(loop.world());
  std::vector<Pose> poses(machine.parts.size());
  std::vector<Vec<6>> velocities(machine.parts.size());
  space.poses(q, poses);
  space.velocities(q, v, velocities);
  for (std::size_t b = 0; b < machine.parts.size(); ++b) {
    if (machine.parts[b].is_world) continue;
    std::string why = what_is_wrong(set, machine.parts[b].body);
    if (why.empty() && !(norm(poses[b].position) <= 1e50 && norm(velocities[b]) <= 1e50)) why = "q and v take it beyond 1e50 m or 1e50 m/s";
    if (!why.empty()) refuse("set_joint_state: body " + std::to_string(b) + ": " + why);
  }
  for (std::size_t b = 0; b < machine.parts.size(); ++b) {
    const model::Part& part = machine.parts[b];
    if (part.is_world || !set.moves(part.body.index)) continue;
    const Mat3 turn = poses[b].rotation * part.pose.rotation.transpose();
    const Vec3 centre = poses[b].position - turn * part.pose.position;
    set.place(part.body, centre, unit(Quat(turn)));
    const Vec3 spin = angular_part(velocities[b]);
    set.set_velocity(part.body, linear_part(velocities[b]) + cross(spin, Vec3(centre - poses[b].position)),
                     spin);
  }
  std::vector<double> coordinates(machine.axes.size());
  for (std::size_t j = 0; j < machine.axes.size(); ++j)
    if (const Index k = space.q_of(Index(j)); k >= 0)
      coordinates[j] = machine.axes[j].coordinate(q[std::size_t(k)]);
  KnownTurns turns(machine, std::move(coordinates));
  tell_laws(loop, turns);
  each_rotor(loop, machine, [](Index, auto& item) { item.rate = from_pose; });  // it turns as the bodies do
  return turns;
}

}  // namespace inner

/// Places all bodies of the machine where q says, with the velocities that v says: see `JointSpace`, which
/// was made with the same model, base and pose as the machine. Limits, springs, couplings and servos count
/// their turns from q on: 4π is the third. Kinematic bodies stay. Refuses a loop that does not have the
/// bodies, before any is placed.
template <class Loop>
void set_joint_state(Loop& loop, Machine& machine, JointSpace& space, std::span<const double> q,
                     std::span<const double> v) {
  const inner::KnownTurns turns = inner::place_joints(loop, machine, space, q, v);
  for (model::Actuation& act : machine.actuators)
    for (TendonPart& part : act.parts) turns.tell(part.kind, part.a, part.b, part.position);
}
/// The same of a machine that is not driven: what `actuate` counts stays as it is.
template <class Loop>
void set_joint_state(Loop& loop, const Machine& machine, JointSpace& space, std::span<const double> q,
                     std::span<const double> v) {
  inner::place_joints(loop, machine, space, q, v);
}

}  // namespace delassus
