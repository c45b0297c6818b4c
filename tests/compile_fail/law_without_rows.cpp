// expect: delassus: a constraint law needs `static constexpr int rows` and a type `Item`; add what is missing
#include <delassus/delassus.hpp>

using namespace delassus;

struct Rope {
  struct Item {
    Anchor a, b;
  };
  void linearize(const Item&, const auto&, auto) const {}
  void project(const Item&, Local<1>&) const {}
};

int main() {
  AnimationLoop loop{World{RigidBodies{}}, Constraints{Rope{}}};
  loop.step(1e-3);
}
