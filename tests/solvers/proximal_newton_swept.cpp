// Islands that Newton's method leaves to the sweeps.
#include "newton_tests.hpp"

namespace proximal_newton_swept_tests {

using namespace newton_tests;

namespace {

/// A law that says nothing of its derivative: a floor at z = 0 for one particle.
struct Floor {
  static constexpr int rows = 1;
  struct Item {
    Anchor a, b = world_anchor({0, 0, 0});
  };
  void linearize(const Item& item, const auto& world, auto row) const {
    const Vec3 x = world.point(item.a);
    row.end(item.a, x).along(0, Vec3::UnitZ());
    row.phi(0, x.z());
  }
  Vec<1> solve_local(const Item&, const Mat<1, 1>& W, const Vec<1>& b) const { return Vec<1>(std::max(0.0, -b[0] / W(0, 0))); }
};

}  // namespace

TEST_CASE("an island whose law has no tangent is swept, and another one is not") {
  AnimationLoop loop{World{RigidBodies{}, Particles{}},
                     Constraints{Contact{Coulomb{.friction = 0.5}}, Floor{}}, ProximalNewton{}};
  add_stack(rigid_bodies(loop), 2, Box{1, 1, 1});
  auto& dust = bodies<Particles>(loop.world());
  const auto grain = dust.add({.position = {5, 0, 0}, .mass = 1.0});
  loop.add(Floor::Item{anchor(dust, grain)});
  REQUIRE(loop.step(h).status == Status::converged);
  REQUIRE(loop.island_reports().size() == 2);
  CHECK(loop.island_reports()[0].factorizations > 0);
  CHECK(loop.island_reports()[0].sweeps == 0);
  CHECK(loop.island_reports()[1].factorizations == 0);
  CHECK(loop.island_reports()[1].sweeps > 0);
}

}  // namespace proximal_newton_swept_tests
