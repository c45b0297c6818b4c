// expect: delassus: this type plays role::Stabilisation but lacks equality(phi, h) or penetration(phi, h)
#include <delassus/delassus.hpp>

using namespace delassus;

struct Gentle {
  using plays = role::Stabilisation;
  double penetration(double phi, double h) const { return 0.1 * phi / h; }
};

int main() {
  AnimationLoop loop{World{RigidBodies{}}, Constraints{BallJoint{}}, Gentle{}};
  loop.step(1e-3);
}
