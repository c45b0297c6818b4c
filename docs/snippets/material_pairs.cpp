// Two materials and a pair of them: how far a block slides says which friction its pair has.
// prints: ice on ice slides 5\.10 m, rubber on ice 0\.34 m, no material on ice 0\.20 m
#include <delassus/delassus.hpp>

#include <cstdio>

using namespace delassus;

/// How far a block of this material slides on ice from 1.4142 m/s, m: v²/(2 μ g).
double slides(int which) {
  AnimationLoop loop{World{RigidBodies{}},
                     Constraints{Contact{Restitution{Coulomb{.friction = 0.5}, 0.0}}}};
  const Index ice = loop.materials().add({.friction = 0.02});
  const Index rubber = loop.materials().add({.friction = 0.9, .restitution = 0.6});
  loop.materials().set_pair(ice, rubber, {.friction = 0.3});  // instead of sqrt(0.02 * 0.9)

  auto& rigid = bodies<RigidBodies>(loop.world());
  rigid.add({.shape = HalfSpace{}, .motion = Motion::fixed, .material = ice});
  const Index material = which == 0 ? ice : which == 1 ? rubber : 0;  // 0: the law's own numbers
  const auto block = rigid.add({.position = {0, 0, 0.05},
                                .velocity = {std::sqrt(2.0), 0, 0},
                                .mass = 1.0,
                                .shape = Box{0.4, 0.4, 0.1},
                                .material = material});
  for (int n = 0; n < 8000; ++n) loop.step(1e-3);
  return rigid.position(block).x();
}

int main() {
  std::printf("ice on ice slides %.2f m, rubber on ice %.2f m, no material on ice %.2f m\n", slides(0), slides(1),
              slides(2));
}
