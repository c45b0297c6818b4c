// expect: delassus: every argument of AnimationLoop is a policy that says its role; add `using plays = role::...;`
#include <delassus/delassus.hpp>

using namespace delassus;

struct Wind {
  double speed = 3;
};

int main() {
  AnimationLoop loop{World{RigidBodies{}}, Wind{}};
  loop.step(1e-3);
}
