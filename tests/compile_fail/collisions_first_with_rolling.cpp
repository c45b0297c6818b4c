// expect: delassus: CollisionsFirst makes a Penalty contact a force with the friction of Coulomb, or with none
#include <delassus/delassus.hpp>

using namespace delassus;

int main() {
  AnimationLoop loop{World{RigidBodies{}}, Constraints{Contact{Penalty{RollingCoulomb{}, 1e5}}}, CollisionsFirst{}};
  loop.step(1e-3);
}
