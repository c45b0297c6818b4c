// expect: delassus: this type plays role::Listener but does not say what it hears; add `using listens =
#include <delassus/delassus.hpp>

using namespace delassus;

struct Counter {
  using plays = role::Listener;
  int steps = 0;
  void after(stage::Step, const auto&) { ++steps; }
};

int main() {
  AnimationLoop loop{World{RigidBodies{}}, Counter{}};
  loop.step(1e-3);
}
