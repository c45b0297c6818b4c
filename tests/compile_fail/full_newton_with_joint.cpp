// expect: delassus: FullNewton moves bodies without joints; take the laws out, or use ImplicitEuler
#include <delassus/delassus.hpp>
#include <delassus/fem/rods.hpp>
#include <delassus/steppers/full_newton.hpp>

using namespace delassus;

int main() {
  AnimationLoop loop{World{Rods{}}, Constraints{BallJoint{}}, FullNewton{}};
  loop.step(1e-3);
}
