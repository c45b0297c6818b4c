// expect: delassus: a constraint law is no argument of AnimationLoop by itself; put it into Constraints{...}, as in Constraints{Contact{Coulomb{.friction = 0.5}}
#include <delassus/delassus.hpp>

using namespace delassus;

int main() {
  AnimationLoop loop{World{RigidBodies{}}, BallJoint{}};
  loop.step(1e-3);
}
