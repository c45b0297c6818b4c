// expect: delassus: WithDeadline and MinimumNorm go around a solver, each at most once, and numbers come second: WithDeadline{MinimumNorm{AcceleratedGaussSeidel{}}, 1e-3}
#include <delassus/delassus.hpp>
#include <delassus/solvers/minimum_norm.hpp>
#include <delassus/solvers/with_deadline.hpp>

using namespace delassus;

int main() {
  AnimationLoop loop{World{RigidBodies{}}, Constraints{BallJoint{}},
                     WithDeadline{MinimumNorm{WithDeadline{AcceleratedGaussSeidel{}, 1e-3}}, 1e-4}};
  loop.step(1e-3);
}
