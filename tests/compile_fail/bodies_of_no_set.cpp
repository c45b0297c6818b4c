// expect: delassus: this World has no set of bodies of this type; add it to World{...}
#include <delassus/delassus.hpp>

using namespace delassus;

int main() {
  AnimationLoop loop{World{RigidBodies{}}};
  bodies<Particles>(loop.world()).add({.mass = 1.0});
  loop.step(1e-3);
}
