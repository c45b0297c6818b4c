/// The beam of the demonstration, and the ball that falls on it.
#pragma once

#include "soft_bodies.hpp"

#include <delassus/bodies/rigid_bodies.hpp>
#include <delassus/bodies/world.hpp>
#include <delassus/geometry/box_mesh.hpp>

namespace demonstration {

/// A beam of one metre, clamped at both ends, under a ball of two kilograms. Returns the ball.
template <class Loop>
delassus::RigidBodies::Handle add_soft_beam(Loop& loop) {
  using namespace delassus;
  auto& soft = bodies<SoftBodies>(loop.world());
  const auto beam = soft.add(
      {.mesh = box_mesh({1, 0.16, 0.08}, {16, 4, 2}), .elasticity = {.young = 2e5}, .contact_radius = 0.01});
  soft.fix(beam, [](const Vec3& x) { return x.x() < 1e-9 || x.x() > 1 - 1e-9; });
  return bodies<RigidBodies>(loop.world()).add({.position = {0.5, 0.08, 0.3}, .mass = 2, .shape = Sphere{0.08}});
}

}  // namespace demonstration
