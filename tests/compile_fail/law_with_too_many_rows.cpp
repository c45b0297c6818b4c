// expect: delassus: a constraint law has from 1 to 32 rows an item; change `rows`, or make two laws of it
#include <delassus/delassus.hpp>

using namespace delassus;

struct Bad {
  static constexpr int rows = 33;
  struct Item {
    Anchor a, b;
  };
  void linearize(const Item&, const auto&, auto row) const { row.phi(0, 0.0); }
  template <class T>
  Vec<rows, T> solve_local(const Item&, const Mat<rows, rows, T>&, const Vec<rows, T>& b) const {
    return b;
  }
};

int main() {
  AnimationLoop loop{World{RigidBodies{}}, Constraints{Bad{}}};
  loop.step(1e-3);
}
