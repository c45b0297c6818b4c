// expect: delassus: this AnimationLoop makes no constraint problem
#include <delassus/delassus.hpp>
#include <delassus/schemes/joint_by_joint.hpp>

using namespace delassus;

int main() {
  AnimationLoop loop{World{RigidBodies{}}, Constraints{BallJoint{}}, JointByJoint{}};
  loop.step(1e-3);
  auto problem = loop.problem();
}
