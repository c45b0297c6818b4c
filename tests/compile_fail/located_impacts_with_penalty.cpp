// expect: delassus: LocatedImpacts takes contacts that hit (no Penalty) and joints whose rows are equalities (no limits, motors, drives and Breakable)
#include <delassus/delassus.hpp>
#include <delassus/loop/located_impacts.hpp>

using namespace delassus;

int main() {
  AnimationLoop loop{World{RigidBodies{}}, Constraints{Contact{Penalty{Coulomb{}, 1e5, 50}}}, LocatedImpacts{}};
  loop.step(1e-3);
}
