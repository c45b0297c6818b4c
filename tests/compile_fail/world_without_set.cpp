// expect: delassus: a World needs at least one set of bodies; write World{RigidBodies{}}
#include <delassus/delassus.hpp>

using namespace delassus;

int main() {
  AnimationLoop loop{World{}};
  loop.step(1e-3);
}
