// expect: delassus: this AnimationLoop has no policy of this role: without constraints, and under JointByJoint, there is no solver and no compliance
#include <delassus/delassus.hpp>
#include <delassus/schemes/joint_by_joint.hpp>

using namespace delassus;

int main() {
  AnimationLoop loop{World{RigidBodies{}}, Constraints{BallJoint{}}, JointByJoint{}};
  return loop.policy<role::Solver>().max_iterations;
}
