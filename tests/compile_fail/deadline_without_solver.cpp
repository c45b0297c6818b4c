// expect: delassus: a deadline goes around a solver, and the seconds come second: WithDeadline{AcceleratedGaussSeidel{}, 1e-3}
#include <delassus/delassus.hpp>

using namespace delassus;

int main() {
  AnimationLoop loop{World{RigidBodies{}}, Constraints{BallJoint{}}, WithDeadline{1e-3}};
  loop.step(1e-3);
}
