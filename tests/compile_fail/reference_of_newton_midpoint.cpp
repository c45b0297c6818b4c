// expect: delassus: NewtonMidpoint makes no problem that a reference could solve again
#include <delassus/delassus.hpp>
#include <delassus/problems/reference_check.hpp>
#include <delassus/steppers/newton_midpoint.hpp>

using namespace delassus;

int main() {
  AnimationLoop loop{World{RigidBodies{}}, Constraints{BallJoint{}}, NewtonMidpoint{}};
  loop.step(1e-3);
  check_against_reference(loop);
}
