// expect: delassus: Audit weighs impulses by W, which NewtonMidpoint, Rattle and RungeKutta4 do without
#include <delassus/delassus.hpp>
#include <delassus/steppers/rattle.hpp>
#include <delassus/study/audit.hpp>

using namespace delassus;

int main() {
  AnimationLoop loop{World{RigidBodies{}}, Constraints{BallJoint{}}, Rattle{}, Audit{}};
  loop.step(1e-3);
}
