// expect: delassus: solve_until(problem, solver, deadline) makes the deadline itself, around a solver without one; of a WithDeadline pass its member `solver`
#include <delassus/delassus.hpp>

using namespace delassus;

int main() {
  AnimationLoop loop{World{RigidBodies{}}, Constraints{BallJoint{}}, WithDeadline{AcceleratedGaussSeidel{}, 1e-3}};
  auto problem = loop.problem();
  solve_until(problem, loop.policy<role::Solver>(), 1e-3);
}
