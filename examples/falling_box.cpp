// A box falls for a second: no collision, no constraint and no solver is compiled.
// prints: height after 1 s: 0\.0901 m
#include <delassus/delassus.hpp>

#include <cstdio>

using namespace delassus;

int main() {
  AnimationLoop loop{World{RigidBodies{}}};
  auto& rigid = bodies<RigidBodies>(loop.world());
  const auto box = rigid.add({.position = {0, 0, 5}, .mass = 2.0, .shape = Box{1, 1, 1}});
  for (int i = 0; i < 1000; ++i) loop.step(1e-3);
  std::printf("height after 1 s: %.4f m\n", rigid.position(box).z());
}
