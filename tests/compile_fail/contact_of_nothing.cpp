// expect: delassus: Contact{...} takes a contact law, as in Contact{Coulomb{.friction = 0.5}}; this type lacks
#include <delassus/delassus.hpp>

using namespace delassus;

int main() {
  AnimationLoop loop{World{RigidBodies{}}, Constraints{Contact{}}};
  loop.step(1e-3);
}
