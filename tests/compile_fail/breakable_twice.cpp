// expect: delassus: Breakable goes around a joint whose rows are forces and moments on its ends, as in Breakable<Hinge>{}; this one does not say so, by `acts`, or breaks already
#include <delassus/delassus.hpp>

using namespace delassus;

int main() {
  AnimationLoop loop{World{RigidBodies{}}, Constraints{Breakable<Breakable<Hinge>>{}}};
  loop.step(1e-3);
}
