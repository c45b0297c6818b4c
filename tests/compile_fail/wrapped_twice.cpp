// expect: delassus: of Restitution, SequentialRestitution and Penalty a contact takes one, for only the outer one would be asked
#include <delassus/delassus.hpp>

using namespace delassus;

int main() {
  AnimationLoop loop{World{RigidBodies{}}, Constraints{Contact{Restitution{Penalty{Coulomb{}, 1e5}, 0.5}}}};
  loop.step(1e-3);
}
