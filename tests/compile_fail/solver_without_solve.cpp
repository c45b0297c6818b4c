// expect: delassus: this type plays role::Solver but lacks `template <class Rows> struct Workspace` or solve(problem, workspace)
#include <delassus/delassus.hpp>

using namespace delassus;

struct Jacobi {
  using plays = role::Solver;
  template <class Rows>
  struct Workspace {};
};

int main() {
  AnimationLoop loop{World{RigidBodies{}}, Constraints{BallJoint{}}, Jacobi{}};
  loop.step(1e-3);
}
