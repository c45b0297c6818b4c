// expect: delassus: this World has two sets of this type; make the second one Tagged<RigidBodies, struct
#include <delassus/delassus.hpp>

using namespace delassus;

int main() {
  AnimationLoop loop{World{RigidBodies{}, RigidBodies{}}};
  bodies<RigidBodies>(loop.world()).add({.mass = 1.0, .shape = Sphere{1}});
  loop.step(1e-3);
}
