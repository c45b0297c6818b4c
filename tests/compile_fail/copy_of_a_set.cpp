// expect: delassus: a copy of a set of bodies, which its loop does not see; write `auto&` for the set of a loop
#include <delassus/delassus.hpp>

#pragma GCC diagnostic error "-Wdeprecated-declarations"

using namespace delassus;

int main() {
  AnimationLoop loop{World{RigidBodies{}}};
  auto rigid = bodies<RigidBodies>(loop.world());
  rigid.add({.mass = 1.0, .shape = Sphere{1}});
}
