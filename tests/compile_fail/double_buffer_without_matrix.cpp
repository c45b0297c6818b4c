// expect: delassus: DoubleBuffer publishes W as a matrix, and this compliance never forms it; take AssembledCompliance
#include <delassus/delassus.hpp>

using namespace delassus;

int main() {
  AnimationLoop loop{World{RigidBodies{}}, Constraints{BallJoint{}}, MatrixFreeCompliance{}, DoubleBuffer{}};
  loop.step(1e-3);
}
