// expect: delassus: a constraint law needs void project(const Item&, Local<rows>&) const; add it
#include <delassus/delassus.hpp>

using namespace delassus;

struct Rope {
  static constexpr int rows = 1;
  struct Item {
    Anchor a, b;
  };
  void linearize(const Item&, const auto&, auto) const {}
};

int main() {
  AnimationLoop loop{World{RigidBodies{}}, Constraints{Rope{}}};
  loop.step(1e-3);
}
