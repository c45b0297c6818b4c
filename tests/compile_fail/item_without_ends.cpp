// expect: delassus: the Item of a law that is added to a loop needs two ends, `Anchor a, b`; one in the world is world_anchor({0, 0, 0})
#include <delassus/delassus.hpp>

using namespace delassus;

struct Wire {
  static constexpr int rows = 1;
  static constexpr bool bilateral = true;
  struct Item {
    Anchor hook;  // no body would feel it
  };
  void linearize(const Item&, const auto&, auto) const {}
  Vec<1> solve_local(const Item&, const Mat<1, 1>&, const Vec<1>& b) const { return b; }
};

int main() {
  AnimationLoop loop{World{Particles{}}, Constraints{Wire{}}};
  const auto bead = bodies<Particles>(loop.world()).add({.mass = 1.0});
  loop.add(Wire::Item{anchor(bodies<Particles>(loop.world()), bead)});
  loop.step(1e-3);
}
