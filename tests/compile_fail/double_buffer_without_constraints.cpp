// expect: delassus: DoubleBuffer publishes the constraint problem, and this loop has none; add Constraints{...}
#include <delassus/delassus.hpp>

using namespace delassus;

int main() {
  AnimationLoop loop{World{RigidBodies{}}, DoubleBuffer{}};
  loop.step(1e-3);
}
