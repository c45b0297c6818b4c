// expect: delassus: NewtonMidpoint, Rattle, RungeKutta4, GeneralizedAlpha, Newmark, Bdf2 and FullNewton make their step at once, without W
#include <delassus/delassus.hpp>
#include <delassus/steppers/newton_midpoint.hpp>

using namespace delassus;

int main() {
  AnimationLoop loop{World{RigidBodies{}}, Constraints{BallJoint{}}, NewtonMidpoint{}, Sleeping{}};
  loop.step(1e-3);
}
