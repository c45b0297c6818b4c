// A chain of eight links hangs from a hook; its tip swings and the joints stay together.
// prints: widest joint gap 0\.000[0-9]* m
#include <delassus/delassus.hpp>

#include <algorithm>
#include <cstdio>

using namespace delassus;

int main() {
  AnimationLoop loop{World{RigidBodies{}}, Constraints{BallJoint{}}, AcceleratedGaussSeidel{.tolerance = 1e-8}};
  auto& rigid = bodies<RigidBodies>(loop.world());

  Anchor end = world_anchor({0, 0, 3});
  RigidBodies::Handle link;
  for (int k = 0; k < 8; ++k) {  // links of 20 cm, released horizontally
    link = rigid.add({.position = {0.2 * k + 0.1, 0, 3}, .mass = 0.1, .shape = Box{0.2, 0.02, 0.02}});
    loop.add(BallJoint::Item{end, anchor(rigid, link, {-0.1, 0, 0})});
    end = anchor(rigid, link, {0.1, 0, 0});
  }

  double gap = 0;
  for (int i = 0; i < 4000; ++i) gap = std::max(gap, loop.step(5e-4).max_joint_violation);
  std::printf("tip at z = %.3f m\nwidest joint gap %.4f m\n", rigid.position(link).z(), gap);
}
