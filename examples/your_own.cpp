// A law and an integrator of your own, outside the library: a rope that pulls and never pushes, and a drag.
// prints: rope length 1\.0000 m
#include <delassus/delassus.hpp>

#include <cstdio>

using namespace delassus;

/// φ = |x_a − x_b| − length ≤ 0, λ ≤ 0: one row that pulls and never pushes.
struct Rope {
  static constexpr int rows = 1;
  static constexpr std::array kinds{RowKind::upper};
  struct Item { Anchor a, b; double length; };

  void linearize(const Item& item, const auto& world, auto row) const {
    const Vec3 xa = world.point(item.a), xb = world.point(item.b), e = (xa - xb).normalized();
    row.end(item.a, xa).along(0, e);
    row.end(item.b, xb).along(0, -e);
    row.phi(0, (xa - xb).norm() - item.length);
  }
  Vec<1> solve_local(const Item&, const Mat<1, 1>& W, const Vec<1>& b) const { return Vec<1>(std::min(0.0, -b[0] / W(0, 0))); }
};

/// Symplectic Euler with a drag: forces lose `rate` of the momentum per second.
struct DraggedEuler : SymplecticEuler {
  double rate = 0.5;
  void impulse(const auto& set, auto& p, double h) const {
    SymplecticEuler::impulse(set, p, h);
    set.add_mass_times_velocity(p, -rate * h);
  }
};

int main() {
  AnimationLoop loop{World{RigidBodies{}}, Constraints{Rope{}}, DraggedEuler{}};
  auto& rigid = bodies<RigidBodies>(loop.world());
  const auto weight = rigid.add({.position = {1, 0, 2}, .mass = 5.0, .shape = Sphere{0.1}});
  loop.add(Rope::Item{world_anchor({0, 0, 2}), anchor(rigid, weight), 1.0});
  for (int i = 0; i < 10000; ++i) loop.step(2e-3);
  std::printf("rope length %.4f m\n", (rigid.position(weight) - Vec3(0, 0, 2)).norm());
}
