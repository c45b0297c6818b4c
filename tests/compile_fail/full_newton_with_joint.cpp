// expect: delassus: Bdf2, FullNewton, GeneralizedAlpha and Newmark move bodies without joints; take the laws out, or use ImplicitEuler or ImplicitMidpoint
#include <delassus/delassus.hpp>
#include <delassus/fem/rods.hpp>
#include <delassus/steppers/full_newton.hpp>

using namespace delassus;

int main() {
  AnimationLoop loop{World{Rods{}}, Constraints{BallJoint{}}, FullNewton{}};
  loop.step(1e-3);
}
