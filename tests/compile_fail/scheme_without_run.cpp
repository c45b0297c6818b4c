// expect: delassus: this type plays role::Scheme but lacks run(step), which calls the stages of a step in its order
#include <delassus/delassus.hpp>

using namespace delassus;

struct Backwards {
  using plays = role::Scheme;
};

int main() {
  AnimationLoop loop{World{RigidBodies{}}, Backwards{}};
  loop.step(1e-3);
}
