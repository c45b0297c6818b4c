// expect: delassus: an integrator with move(step), such as NewtonMidpoint, takes no contacts, limits, motors and drives; take their laws out, or use SymplecticEuler, ImplicitEuler, ImplicitMidpoint or LiePoisson
#include <delassus/delassus.hpp>
#include <delassus/steppers/runge_kutta4.hpp>

using namespace delassus;

int main() {
  AnimationLoop loop{World{RigidBodies{}}, Constraints{Limit<Turn>{}}, RungeKutta4{}};
  loop.step(1e-3);
}
