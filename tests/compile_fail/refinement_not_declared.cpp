// expect: delassus: a law has a member clamp that it does not declare, so that nobody would call it; add refine::clamp to its `refines`, or give it another name
#include <delassus/delassus.hpp>

using namespace delassus;

struct Rope {
  static constexpr int rows = 1;
  struct Item {
    Anchor a, b;
  };
  void linearize(const Item&, const auto&, auto) const {}
  Vec<1> solve_local(const Item&, const Mat<1, 1>&, const Vec<1>& b) const { return b; }
  template <class T>
  void clamp(const Item&, Vec<1, T>& lambda) const {
    lambda[0] = 0;
  }
  void clamp(double) const {}
};

int main() {
  AnimationLoop loop{World{RigidBodies{}}, Constraints{Rope{}}};
  loop.step(1e-3);
}
