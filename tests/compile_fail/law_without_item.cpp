// expect: delassus: a constraint law needs `static constexpr int rows` and a type `Item`; add what is missing
#include <delassus/delassus.hpp>

using namespace delassus;

struct Rope {
  static constexpr int rows = 1;
};

int main() {
  AnimationLoop loop{World{RigidBodies{}}, Constraints{Rope{}}};
  loop.step(1e-3);
}
