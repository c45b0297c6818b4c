// expect: delassus: GeneralizedAlpha moves bodies without joints; take the laws out, or use ImplicitMidpoint
#include <delassus/delassus.hpp>
#include <delassus/steppers/generalized_alpha.hpp>

using namespace delassus;

int main() {
  AnimationLoop loop{World{Particles{}}, Constraints{DistanceJoint{}}, GeneralizedAlpha{}};
  loop.step(1e-3);
}
