// expect: delassus: JointByJoint moves rigid bodies and particles, by SymplecticEuler or LiePoisson
#include <delassus/delassus.hpp>
#include <delassus/schemes/joint_by_joint.hpp>

using namespace delassus;

int main() {
  AnimationLoop loop{World{RigidBodies{}}, Constraints{BallJoint{}}, ImplicitMidpoint{}, JointByJoint{}};
  loop.step(1e-3);
}
