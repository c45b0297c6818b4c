// expect: delassus: this type plays role::Scheme but lacks run(loop), which calls the stages of the loop in its order
#include <delassus/delassus.hpp>

using namespace delassus;

struct Backwards {
  using plays = role::Scheme;
};

int main() {
  AnimationLoop loop{World{RigidBodies{}}, Backwards{}};
  loop.step(1e-3);
}
