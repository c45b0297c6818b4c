// expect: delassus: this AnimationLoop has no part of this type; name it among the arguments, or ask for the part of a role, loop.part<role::Solver>()
#include <delassus/delassus.hpp>

using namespace delassus;

int main() {
  AnimationLoop loop{World{RigidBodies{}}, Constraints{BallJoint{}}};
  loop.step(1e-3);
  return int(loop.get<Stopwatch>().last().size());
}
