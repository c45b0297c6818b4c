// expect: delassus: Bdf2, FullNewton, GeneralizedAlpha and Newmark move bodies without joints; take the laws out, or use ImplicitEuler or ImplicitMidpoint
#include <delassus/delassus.hpp>
#include <delassus/steppers/generalized_alpha.hpp>

using namespace delassus;

int main() {
  AnimationLoop loop{World{Particles{}}, Constraints{DistanceJoint{}}, GeneralizedAlpha{}};
  loop.step(1e-3);
}
