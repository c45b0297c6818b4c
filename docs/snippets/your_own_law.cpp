// A law of your own: a rope that pulls and never pushes, with a check, a cone and a derivative for Newton's method.
// prints: slack in [1-9][0-9]* steps, taut at 1\.0000 m, tension 49\.05 N
#include <delassus/delassus.hpp>
#include <delassus/solvers/proximal_newton.hpp>

#include <algorithm>
#include <array>
#include <cstdio>

using namespace delassus;

struct Rope {
  static constexpr int rows = 1;
  static constexpr std::array kinds{RowKind::upper};  // φ ≤ 0, λ ≤ 0
  static constexpr auto refines = refine::check | refine::clamp | refine::tangent;

  struct Item {
    Anchor a, b;
    double length = 1;  // m
  };

  // φ = |x_a − x_b| − length and its gradient at each end.
  void linearize(const Item& item, const auto& world, auto row) const {
    const Vec3 xa = world.point(item.a), xb = world.point(item.b), span = xa - xb;
    const double distance = span.norm();
    const Vec3 e = distance > 0 ? Vec3(span / distance) : Vec3(0, 0, 1);
    row.end(item.a, xa).along(0, e);
    row.end(item.b, xb).along(0, -e);
    row.phi(0, distance - item.length);
  }

  // The impulse of the rope alone: u = W λ + b, u ≤ 0, λ ≤ 0, u λ = 0.
  template <class T>
  Vec<1, T> solve_local(const Item&, const Mat<1, 1, T>& W, const Vec<1, T>& b) const {
    return Vec<1, T>(std::min(T(0), -b[0] / W(0, 0)));
  }

  void check(const Item& item) const {
    if (!(item.length > 0)) throw InvalidArgument("Rope: length must be > 0 m");
  }
  template <class T>
  void clamp(const Item&, Vec<1, T>& lambda) const {
    lambda[0] = std::min(T(0), lambda[0]);
  }
  template <class T>
  Mat<1, 1, T> tangent(const Item&, Local<1, T>& c) const {
    c.lambda[0] = std::min(T(0), c.lambda[0] - c.d[0] / c.W(0, 0));
    return Mat<1, 1, T>(c.lambda[0] < T(0) ? T(1) / c.W(0, 0) : T(0));
  }
};

int main() {
  AnimationLoop loop{World{RigidBodies{}}, Constraints{Rope{}}, ProximalNewton{}};
  auto& rigid = bodies<RigidBodies>(loop.world());
  const auto weight = rigid.add({.position = {0, 0, 1.5}, .mass = 5.0, .shape = Sphere{0.1}});
  const auto rope = loop.add(Rope::Item{.a = anchor(rigid, weight), .b = world_anchor({0, 0, 2}), .length = 1.0});

  const double h = 2e-3;
  int slack = 0;
  for (int i = 0; i < 1000; ++i) {
    loop.step(h);
    slack += loop.impulse(rope)[0] == 0;
  }
  std::printf("slack in %d steps, taut at %.4f m, tension %.2f N\n", slack, 2 - rigid.position(weight).z(),
              -loop.impulse(rope)[0] / h);

  try {
    loop.add(Rope::Item{.a = anchor(rigid, weight), .b = world_anchor({0, 0, 2}), .length = 0});
  } catch (const InvalidArgument& error) {
    std::printf("refused: %s\n", error.what());
  }
}
