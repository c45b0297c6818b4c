// expect: delassus: this AnimationLoop stores no constraints of this type; list its law in Constraints{...}
#include <delassus/delassus.hpp>

using namespace delassus;

int main() {
  AnimationLoop loop{World{RigidBodies{}}, Constraints{BallJoint{}}};
  loop.add(DistanceJoint::Item{.length = 1});
  loop.step(1e-3);
}
