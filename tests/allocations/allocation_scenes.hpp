/// Counting allocations in warm steps.
#pragma once

#include "allocations/count_allocations.hpp"

#include "scenes.hpp"

#include "catch.hpp"

using namespace scenes;

/// Of `steps` steps after `warm` others. Eigen, which calls malloc, asserts if it wants memory in them.
template <class Loop>
long allocations_of(Loop& loop, int warm, int steps) {
  const double h = 1.0 / 60;
  for (int n = 0; n < warm; ++n) loop.step(h);
  const long before = allocations;
  Eigen::internal::set_is_malloc_allowed(false);
  for (int n = 0; n < steps; ++n) loop.step(h);
  Eigen::internal::set_is_malloc_allowed(true);
  return allocations - before;
}

/// Ten boxes on each other, a pendulum of two rods beside them that hits the stack's foot, and material pairs in use.
template <class Backend>
long allocations_of_jointed_stack(Backend backend) {
  AnimationLoop loop{World{RigidBodies{}}, Constraints{Contact{Restitution{Coulomb{.friction = 0.5}, 0.2}}, BallJoint{}},
                     std::move(backend), AcceleratedGaussSeidel{.max_iterations = 200}};
  auto& set = rigid_bodies(loop);
  add_stack(set, 10, Box{1, 1, 1});
  loop.materials().add({.friction = 0.4, .restitution = 0.1});
  const auto upper = set.add({.position = {1.5, 0, 5}, .mass = 0.2, .shape = Box{0.1, 0.1, 2}, .material = 1});
  const auto lower = set.add({.position = {1.5, 0, 3}, .mass = 0.2, .shape = Box{0.1, 0.1, 2}, .material = 1});
  loop.add(BallJoint::Item{anchor(set, upper, {0, 0, 1}), world_anchor({1.5, 0, 6})});
  loop.add(BallJoint::Item{anchor(set, lower, {0, 0, 1}), anchor(set, upper, {0, 0, -1})});
  set.set_velocity(lower, {2, 0, 0});
  return allocations_of(loop, 500, 1000);
}

/// Six links on ball joints, released horizontally.
template <class Integrator>
long allocations_of_swinging_chain(Integrator integrator) {
  AnimationLoop loop{World{RigidBodies{}}, Constraints{BallJoint{}}, std::move(integrator)};
  auto& set = rigid_bodies(loop);
  Anchor end = world_anchor({0, 0, 0});
  for (int k = 0; k < 6; ++k) {
    const auto link = set.add({.position = {0.5 * k + 0.25, 0, 0}, .mass = 1.0, .shape = Box{0.5, 0.2, 0.2}});
    loop.add(BallJoint::Item{end, anchor(set, link, {-0.25, 0, 0})});
    end = anchor(set, link, {0.25, 0, 0});
  }
  return allocations_of(loop, 100, 1000);
}
