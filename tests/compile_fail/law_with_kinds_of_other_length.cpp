// expect: delassus: the `kinds` of a constraint law are one for each of its rows; write
#include <delassus/delassus.hpp>

#include <array>

using namespace delassus;

struct Bad {
  static constexpr int rows = 2;
  static constexpr std::array<RowKind, 3> kinds{};
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
