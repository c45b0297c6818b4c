// expect: delassus: a constraint law needs linearize(const Item&, const auto& world, auto row) const; add it
#include <delassus/delassus.hpp>

using namespace delassus;

struct Rope {
  static constexpr int rows = 1;
  struct Item {
    Anchor a, b;
  };
  Vec<1> solve_local(const Item&, const Mat<1, 1>&, const Vec<1>& b) const { return b; }
};

int main() {
  AnimationLoop loop{World{RigidBodies{}}, Constraints{Rope{}}};
  loop.step(1e-3);
}
