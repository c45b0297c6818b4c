// expect: so does MinimumNorm{AcceleratedGaussSeidel{}}
#include <delassus/delassus.hpp>
#include <delassus/solvers/minimum_norm.hpp>

using namespace delassus;

int main() {
  AnimationLoop loop{World{RigidBodies{}}, Constraints{BallJoint{}}, MinimumNorm{1e-3}};
  loop.step(1e-3);
}
