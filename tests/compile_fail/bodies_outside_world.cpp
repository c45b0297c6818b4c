// expect: delassus: a set of bodies is no argument of AnimationLoop by itself; put it into World{...}, as in World{RigidBodies{}}
#include <delassus/delassus.hpp>

using namespace delassus;

int main() {
  AnimationLoop loop{RigidBodies{}, Constraints{BallJoint{}}};
  loop.step(1e-3);
}
