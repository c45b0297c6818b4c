// expect: delassus: a law declares refine::clamp, but void clamp(item, Vec<rows, T>& lambda) const, outside contacts with const Memory<T>& or without, is not there or has other types
#include <delassus/delassus.hpp>

using namespace delassus;

struct Rope {
  static constexpr int rows = 1;
  static constexpr auto refines = refine::clamp;
  struct Item {
    Anchor a, b;
  };
  void linearize(const Item&, const auto&, auto) const {}
  Vec<1> solve_local(const Item&, const Mat<1, 1>&, const Vec<1>& b) const { return b; }
  void clamp(const Item&, Vec<1> lambda) const { lambda[0] = 0; }
};

int main() {
  AnimationLoop loop{World{RigidBodies{}}, Constraints{Rope{}}};
  loop.step(1e-3);
}
