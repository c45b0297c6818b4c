// expect: delassus: WithDeadline and MinimumNorm go around a solver, each at most once, and numbers come second: WithDeadline{MinimumNorm{AcceleratedGaussSeidel{}}, 1e-3}
#include <delassus/delassus.hpp>

using namespace delassus;

int main() {
  AnimationLoop loop{World{RigidBodies{}}, Constraints{BallJoint{}}, WithDeadline{1e-3, AcceleratedGaussSeidel{}}};
  loop.step(1e-3);
}
