// expect: delassus: this listener declares a stage in `listens` for which it has no after(stage::X, step)
#include <delassus/delassus.hpp>

using namespace delassus;

struct Counter {
  using plays = role::Listener;
  using listens = Listens<stage::Step, stage::Solve>;
  int steps = 0;
  void after(stage::Step, const auto&) { ++steps; }
};

int main() {
  AnimationLoop loop{World{RigidBodies{}}, Counter{}};
  loop.step(1e-3);
}
