// expect: delassus: a constraint law needs Vec<rows, T> solve_local(const Item&, const Mat<rows, rows, T>& W, const Vec<rows, T>& b) const, in a contact with its Parameters as item, and with Memory<T>& behind b if it has a Memory; add it
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
