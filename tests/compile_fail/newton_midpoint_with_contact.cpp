// expect: delassus: NewtonMidpoint, Rattle and RungeKutta4 solve equalities; contacts, limits, motors and drives need another integrator
#include <delassus/delassus.hpp>
#include <delassus/loop/newton_midpoint.hpp>

using namespace delassus;

int main() {
  AnimationLoop loop{World{RigidBodies{}}, Constraints{Contact{Coulomb{}}, BallJoint{}}, NewtonMidpoint{}};
  loop.step(1e-3);
}
