// Ten boxes on each other by the default parts: scripts/quick.py counts the instructions of their steps.
#include <delassus/bodies/rigid_bodies.hpp>
#include <delassus/collision/native.hpp>
#include <delassus/constraints/contact/coulomb.hpp>
#include <delassus/loop/animation_loop.hpp>

#include <cstdio>
#include <cstdlib>

using namespace delassus;

#ifndef NAMED
#define NAMED  // `, Serial{}` where compiled_to.py compares
#endif

int main(int, char** words) {
  AnimationLoop loop{World{RigidBodies{}}, Constraints{Contact{Coulomb{.friction = 0.5}}} NAMED};
  auto& set = bodies<RigidBodies>(loop.world());
  set.add_fixed(HalfSpace{});
  RigidBodies::Handle top;
  for (int i = 0; i < 10; ++i)
    top = set.add({.position = {1e-3 * (i % 3), 1e-3 * (i % 2), 0.501 + 1.001 * i}, .mass = 1.0, .shape = Box{1, 1, 1}});
  for (int n = std::atoi(words[1]); n > 0; --n) loop.step(5e-3);
  std::printf("%.17g\n", set.position(top).z());
}
