// expect: delassus: World{...} takes sets of bodies, as in World{RigidBodies{}, Particles{}}; take the rest out
#include <delassus/delassus.hpp>

using namespace delassus;

int main() {
  AnimationLoop loop{World{RigidBodies{}, BallJoint{}}, Constraints{BallJoint{}}};
  loop.step(1e-3);
}
