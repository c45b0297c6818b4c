// expect: delassus: LocatedImpacts flies a step more than once; take out the activity, Sleeping or HandPicked
#include <delassus/delassus.hpp>
#include <delassus/loop/located_impacts.hpp>

using namespace delassus;

int main() {
  AnimationLoop loop{World{RigidBodies{}}, Constraints{Contact{Coulomb{}}}, LocatedImpacts{}, Sleeping{}};
  loop.step(1e-3);
}
