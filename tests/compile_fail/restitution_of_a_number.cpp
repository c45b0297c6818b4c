// expect: delassus: Restitution, SequentialRestitution and Penalty go around a contact law, and their numbers come second: Contact{Restitution{Coulomb{.friction = 0.5}, 0.3}}, Contact{Penalty{Coulomb{}, 1e5, 50}}
#include <delassus/delassus.hpp>

using namespace delassus;

int main() {
  AnimationLoop loop{World{RigidBodies{}}, Constraints{Contact{Restitution{0.5}}}};
  loop.step(1e-3);
}
