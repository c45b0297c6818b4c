// expect: delassus: an AnimationLoop is not copied silently; write `auto& loop` for the one that is there
#include <delassus/delassus.hpp>

using namespace delassus;

int main() {
  AnimationLoop loop{World{RigidBodies{}}};
  auto copy = loop;
  copy.step(1e-3);
}
