// expect: delassus: this AnimationLoop has no policy of this type; name it among the arguments, or ask for the policy of a role, loop.policy<role::Solver>()
#include <delassus/delassus.hpp>

using namespace delassus;

int main() {
  AnimationLoop loop{World{RigidBodies{}}, Constraints{BallJoint{}}};
  loop.step(1e-3);
  return int(loop.get<Stopwatch>().last().size());
}
