// A stack of five boxes on the ground, and a gate on a hinge with a limit and a motor.
// prints: top at 4\.500 m, gate at 1\.200 rad
#include <delassus/delassus.hpp>

#include <cstdio>

using namespace delassus;

int main() {
  AnimationLoop loop{World{RigidBodies{}},
                     Constraints{Contact{Coulomb{.friction = 0.6}}, Hinge{}, Limit<Turn>{}, Motor<Turn>{}}};
  auto& rigid = bodies<RigidBodies>(loop.world());
  rigid.add_fixed(HalfSpace{});  // solid below z = 0
  RigidBodies::Handle top;
  for (int i = 0; i < 5; ++i)
    top = rigid.add({.position = {0, 0, 0.5 + i}, .mass = 1, .shape = Box{1, 1, 1}});

  const auto gate = rigid.add({.position = {3.5, 0, 1.5}, .mass = 10, .shape = Box{1, 0.1, 1}});
  const Anchor post = world_anchor({3, 0, 1.5});  // a hinge turns about the z axis of its frames
  const Anchor leaf = anchor(rigid, gate, {-0.5, 0, 0});
  loop.add(Hinge::Item{post, leaf});
  loop.add(Limit<Turn>::Item{.a = post, .b = leaf, .lower = 0, .upper = 1.2});
  const auto motor = loop.add(Motor<Turn>::Item{.a = post, .b = leaf, .speed = 1, .max_force = 20});

  for (int i = 0; i < 1000; ++i) loop.step(2e-3);
  std::printf("top at %.3f m, gate at %.3f rad\n", rigid.position(top).z(), loop.item(motor).position);
}
