/// Pendulums of the library, as the programs that step_cost.py counts let them swing.
#pragma once

#include "step_scenes.hpp"

#include <delassus/delassus.hpp>

namespace step_scenes {

/// Side by side: one shows what a step costs before anything is done, a hundred what a constraint costs. The policies are
/// constraints and, if it is not the default, a scheme.
template <int pendulums, class... Policies>
struct LibraryPendulums {
  AnimationLoop<World<RigidBodies>, Policies...> loop{World{RigidBodies{}}, Policies{}...};
  LibraryPendulums() {
    auto& set = bodies<RigidBodies>(loop.world());
    for (int i = 0; i < pendulums; ++i) {
      const auto bob = set.add({.position = {1, 3.0 * i, 0}, .mass = 1.0, .inertia = moments(1)});
      loop.add(BallJoint::Item{anchor(set, bob, {-1, 0, 0}), world_anchor({0, 3.0 * i, 0})});
    }
  }
  [[gnu::noinline]] void step() { loop.step(h); }
  double answer() { return bodies<RigidBodies>(loop.world()).point({.block = 0}).z(); }
};

}  // namespace step_scenes
