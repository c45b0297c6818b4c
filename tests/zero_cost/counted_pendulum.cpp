// A rod on a ball joint by the default parts: scripts/quick.py counts the instructions of its steps.
#include <delassus/bodies/rigid_bodies.hpp>
#include <delassus/constraints/joints/ball_joint.hpp>
#include <delassus/loop/animation_loop.hpp>

#include <cstdio>
#include <cstdlib>

using namespace delassus;

int main(int, char** words) {
  AnimationLoop loop{World{RigidBodies{}}, Constraints{BallJoint{}}};
  auto& set = bodies<RigidBodies>(loop.world());
  const auto rod = set.add({.position = {1, 0, 0}, .mass = 1.0, .shape = Box{2, 0.1, 0.1}});
  loop.add(BallJoint::Item{anchor(set, rod, {-1, 0, 0}), world_anchor({0, 0, 0})});
  for (int n = std::atoi(words[1]); n > 0; --n) loop.step(1e-3);
  std::printf("%.17g\n", set.position(rod).z());
}
