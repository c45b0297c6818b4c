// expect: delassus: this type plays role::Compliance but lacks `template <class Rows> class Operator`
#include <delassus/delassus.hpp>

using namespace delassus;

struct MassOnly {
  using plays = role::Compliance;
};

int main() {
  AnimationLoop loop{World{RigidBodies{}}, Constraints{BallJoint{}}, MassOnly{}};
  loop.step(1e-3);
}
