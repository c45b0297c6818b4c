// expect: delassus: NewtonMidpoint, Rattle and RungeKutta4 solve equalities; contacts, limits, motors and drives need another integrator
#include <delassus/delassus.hpp>
#include <delassus/loop/runge_kutta4.hpp>

using namespace delassus;

int main() {
  AnimationLoop loop{World{RigidBodies{}}, Constraints{Limit<Turn>{}}, RungeKutta4{}};
  loop.step(1e-3);
}
