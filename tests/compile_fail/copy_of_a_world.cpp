// expect: delassus: a World is not copied silently; write `auto& world` for the one of a loop
#include <delassus/delassus.hpp>

using namespace delassus;

int main() {
  AnimationLoop loop{World{RigidBodies{}}};
  auto world = loop.world();
  bodies<RigidBodies>(world).add({.mass = 1.0, .shape = Sphere{1}});
}
