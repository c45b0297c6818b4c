// expect: delassus: JointByJoint takes joints with two ends that hold exactly or by springs
#include <delassus/delassus.hpp>
#include <delassus/schemes/joint_by_joint.hpp>

using namespace delassus;

int main() {
  AnimationLoop loop{World{RigidBodies{}}, Constraints{BallJoint{}, Contact{Coulomb{}}}, JointByJoint{}};
  loop.step(1e-3);
}
