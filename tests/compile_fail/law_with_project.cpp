// expect: delassus: a constraint law needs Vec<rows> solve_local(item, W, b) const in the place of project(item, local); see docs/project/migration.md
#include <delassus/delassus.hpp>

using namespace delassus;

struct Rope {
  static constexpr int rows = 1;
  struct Item {
    Anchor a, b;
  };
  void linearize(const Item&, const auto&, auto) const {}
  template <class T>
  void project(const Item&, Local<1, T>& c) const {
    c.lambda -= c.d;
  }
};

int main() {
  AnimationLoop loop{World{RigidBodies{}}, Constraints{Rope{}}};
  loop.step(1e-3);
}
