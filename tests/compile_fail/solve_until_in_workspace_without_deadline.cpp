// expect: delassus: solve_until takes the workspace of the solver in its deadline: SolverWorkspace<decltype(problem), WithDeadline<AcceleratedGaussSeidel>> for an AcceleratedGaussSeidel
#include <delassus/delassus.hpp>

using namespace delassus;

int main() {
  AnimationLoop loop{World{RigidBodies{}}, Constraints{BallJoint{}}};
  auto problem = loop.problem();
  SolverWorkspace<decltype(problem), AcceleratedGaussSeidel> workspace;
  solve_until(problem, AcceleratedGaussSeidel{}, 1e-3, workspace);
}
