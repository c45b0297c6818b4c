// expect: delassus: Breakable goes around a joint whose rows are forces and moments on its ends, as in Breakable<Hinge>{}
#include <delassus/delassus.hpp>

using namespace delassus;

int main() {
  AnimationLoop loop{World{RigidBodies{}}, Constraints{Breakable<Gear>{}}};
  loop.step(1e-3);
}
