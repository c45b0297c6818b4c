// expect: delassus: a law with restitution(item) names what makes it bounce; add `using overrides = Overrides<NewtonImpact>;`
#include <delassus/delassus.hpp>

using namespace delassus;

struct Buffer : BallJoint {
  static constexpr auto refines = BallJoint::refines | refine::restitution;
  double restitution(const Item&) const { return 0.5; }
};

int main() {
  AnimationLoop loop{World{RigidBodies{}}, Constraints{Buffer{}}};
  loop.step(1e-3);
}
