// expect: delassus: a constraint law needs `static constexpr int rows` and a type `Item`; add what is missing
#include <delassus/delassus.hpp>

using namespace delassus;

struct Rope {
  struct Item {
    Anchor a, b;
  };
  void linearize(const Item&, const auto&, auto) const {}
  Vec<1> solve_local(const Item&, const Mat<1, 1>&, const Vec<1>& b) const { return b; }
};

int main() {
  AnimationLoop loop{World{RigidBodies{}}, Constraints{Rope{}}};
  loop.step(1e-3);
}
