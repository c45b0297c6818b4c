/// The chain of the demonstration.
#pragma once

#include <delassus/bodies/rigid_bodies.hpp>
#include <delassus/bodies/world.hpp>
#include <delassus/constraints/joints/ball_joint.hpp>

namespace demonstration {

/// Twenty links of half a kilogram on ball joints, held at one end, released horizontally.
template <class Loop>
void add_hanging_chain(Loop& loop) {
  using namespace delassus;
  auto& rigid = bodies<RigidBodies>(loop.world());
  const double length = 0.25, radius = 0.06;
  const Quat lying(Eigen::AngleAxisd(EIGEN_PI / 2, Vec3::UnitY()));
  Anchor end = world_anchor({0, 0, 5.5});
  for (int k = 0; k < 20; ++k) {
    const auto link = rigid.add({.position = {length * (k + 0.5), 0, 5.5},
                                 .orientation = lying,
                                 .mass = 0.5,
                                 .shape = Capsule{radius, length - 2 * radius}});
    loop.add(BallJoint::Item{end, anchor(rigid, link, {0, 0, -length / 2})});
    end = anchor(rigid, link, {0, 0, length / 2});
  }
}

}  // namespace demonstration
