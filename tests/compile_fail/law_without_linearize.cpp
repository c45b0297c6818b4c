// expect: delassus: a constraint law needs linearize(const Item&, const auto& world, auto row) const; add it
#include <delassus/delassus.hpp>

using namespace delassus;

struct Rope {
  static constexpr int rows = 1;
  struct Item {
    Anchor a, b;
  };
  void project(const Item&, Local<1>&) const {}
};

int main() {
  AnimationLoop loop{World{RigidBodies{}}, Constraints{Rope{}}};
  loop.step(1e-3);
}
