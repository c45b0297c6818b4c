// expect: delassus: an integrator with move(step), such as NewtonMidpoint, takes no contacts, limits, motors and drives; take their laws out, or use SymplecticEuler, ImplicitEuler, ImplicitMidpoint or LiePoisson
#include <delassus/delassus.hpp>
#include <delassus/fem/rods.hpp>
#include <delassus/steppers/full_newton.hpp>

using namespace delassus;

int main() {
  AnimationLoop loop{World{RigidBodies{}, Rods{}}, Constraints{Contact{Coulomb{}}}, FullNewton{}};
  loop.step(1e-3);
}
