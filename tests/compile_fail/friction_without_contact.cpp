// expect: delassus: the law of a contact stands within Contact{...}, as in Constraints{Contact{Coulomb{.friction = 0.5}}}
#include <delassus/delassus.hpp>

using namespace delassus;

int main() {
  AnimationLoop loop{World{RigidBodies{}}, Constraints{Coulomb{.friction = 0.5}}};
  loop.step(1e-3);
}
