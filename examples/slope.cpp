// A block on a slope of 30 degrees sticks while the friction coefficient is above tan 30 = 0.577, else slips.
// prints: sticks at 0\.60: moved 0\.000 m, slips at 0\.50: moved 1\.3[0-9]* m
#include <delassus/delassus.hpp>

#include <cstdio>

using namespace delassus;

double slide(double friction) {
  AnimationLoop loop{World{RigidBodies{}}, Constraints{Contact{Coulomb{.friction = friction}}}};
  auto& rigid = bodies<RigidBodies>(loop.world());
  const double angle = 3.14159265358979 / 6;
  rigid.gravity = 9.81 * Vec3(std::sin(angle), 0, -std::cos(angle));
  rigid.add_fixed(HalfSpace{});
  const auto block = rigid.add({.position = {0, 0, 0.25}, .mass = 1.0, .shape = Box{1, 1, 0.5}});
  for (int i = 0; i < 200; ++i) loop.step(1e-2);
  return rigid.position(block).x();
}

int main() {
  std::printf("sticks at 0.60: moved %.3f m, slips at 0.50: moved %.3f m\n", std::abs(slide(0.6)),
              slide(0.5));
}

