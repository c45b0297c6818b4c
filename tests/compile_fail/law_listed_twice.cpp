// expect: delassus: Constraints{...} lists this law twice; one entry holds any number of constraints, take
#include <delassus/delassus.hpp>

using namespace delassus;

int main() {
  AnimationLoop loop{World{RigidBodies{}}, Constraints{BallJoint{}, BallJoint{}}};
  auto& set = bodies<RigidBodies>(loop.world());
  const auto bob = set.add({.mass = 1.0, .shape = Sphere{1}});
  loop.add(BallJoint::Item{anchor(set, bob), world_anchor({0, 0, 1})});
  loop.step(1e-3);
}
