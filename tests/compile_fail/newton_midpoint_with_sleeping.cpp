// expect: delassus: an integrator with move(step), such as NewtonMidpoint, makes its step at once, without W
#include <delassus/delassus.hpp>
#include <delassus/steppers/newton_midpoint.hpp>

using namespace delassus;

int main() {
  AnimationLoop loop{World{RigidBodies{}}, Constraints{BallJoint{}}, NewtonMidpoint{}, Sleeping{}};
  loop.step(1e-3);
}
