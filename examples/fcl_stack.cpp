// The stack again, with FCL as the collision backend: one word in the argument list.
// prints: top at 9\.5000 m
#include <delassus/adapters/fcl.hpp>
#include <delassus/delassus.hpp>

#include <cstdio>

using namespace delassus;

int main() {
  AnimationLoop loop{World{RigidBodies{}}, Constraints{Contact{Coulomb{.friction = 0.6}}}, FclCollision{.margin = 0.01}};
  auto& rigid = bodies<RigidBodies>(loop.world());
  rigid.add_fixed(HalfSpace{});
  RigidBodies::Handle top;
  for (int k = 0; k < 10; ++k)
    top = rigid.add({.position = {0, 0, 0.5 + k}, .mass = 1.0, .shape = Box{1, 1, 1}});
  StepReport report;
  for (int i = 0; i < 600; ++i) report = loop.step(1.0 / 60);
  std::printf("%s, residual %.1e, %d contacts\ntop at %.4f m\n", name(report.status), report.residual, report.contacts,
              rigid.position(top).z());
}
