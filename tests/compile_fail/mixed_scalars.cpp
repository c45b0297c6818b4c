// expect: delassus: all body sets of a World have one scalar; use RigidBodies with Particles, or RigidBodiesF
#include <delassus/delassus.hpp>

using namespace delassus;

int main() {
  AnimationLoop loop{World{RigidBodies{}, ParticlesF{}}, Constraints{BallJoint{}}};
  loop.step(1e-3);
}
