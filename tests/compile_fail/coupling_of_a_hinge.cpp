// expect: delassus: Limit, Motor and Drive act on one axis of a joint; write Motor<Turn>{} for an angle (rad), Motor<Slide>{} for a way (m); a Coupling on two, as in Coupling<Turn, Slide>{}
#include <delassus/delassus.hpp>

using namespace delassus;

int main() {
  AnimationLoop loop{World{RigidBodies{}}, Constraints{Hinge{}, Coupling<Hinge, Turn>{}}};
  loop.step(1e-3);
}
