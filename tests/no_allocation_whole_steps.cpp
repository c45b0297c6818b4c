// A program of its own: it counts every call of operator new, and has Eigen stop at an allocation in a warm
// step.
#define EIGEN_RUNTIME_NO_MALLOC
#include "allocation_scenes.hpp"

#include <delassus/loop/rattle.hpp>
#include <delassus/loop/runge_kutta4.hpp>

TEMPLATE_TEST_CASE(
    "a warm step of a swinging chain allocates nothing under an integrator that makes its whole step", "",
    Rattle, RungeKutta4) {
  AnimationLoop loop{World{RigidBodies{}}, Constraints{BallJoint{}}, TestType{}};
  auto& set = rigid_bodies(loop);
  Anchor end = world_anchor({0, 0, 0});
  for (int k = 0; k < 6; ++k) {
    const auto link = set.add({.position = {0.5 * k + 0.25, 0, 0}, .mass = 1.0, .shape = Box{0.5, 0.2, 0.2}});
    loop.add(BallJoint::Item{end, anchor(set, link, {-0.25, 0, 0})});
    end = anchor(set, link, {0.25, 0, 0});
  }
  REQUIRE(allocations_of(loop, 100, 1000) == 0);
}
