// expect: delassus: JointByJoint solves without W and without a solver
#include <delassus/delassus.hpp>
#include <delassus/schemes/joint_by_joint.hpp>

using namespace delassus;

int main() {
  AnimationLoop loop{World{RigidBodies{}}, Constraints{BallJoint{}}, GaussSeidel{}, JointByJoint{}};
  loop.step(1e-3);
}
