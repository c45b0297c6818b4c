// expect: delassus: a collision backend without a contact law does nothing; add Contact{...} to Constraints{...}
#include <delassus/delassus.hpp>

using namespace delassus;

int main() {
  AnimationLoop loop{World{RigidBodies{}}, Constraints{BallJoint{}}, NativeCollision{}};
  loop.step(1e-3);
}
