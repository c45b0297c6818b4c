// expect: delassus: an AnimationLoop takes at most one policy of each role (listeners aside); take one out
#include <delassus/delassus.hpp>

using namespace delassus;

int main() {
  AnimationLoop loop{World{RigidBodies{}}, SymplecticEuler{}, ImplicitMidpoint{}};
  loop.step(1e-3);
}
