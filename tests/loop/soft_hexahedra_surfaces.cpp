// The surfaces of hexahedra in contact between their nodes.
#include <delassus/bodies/world.hpp>
#include <delassus/collision/native.hpp>
#include <delassus/collision/with_surfaces.hpp>
#include <delassus/constraints/contact/coulomb.hpp>
#include <delassus/integrators/implicit_euler.hpp>
#include <delassus/loop/animation_loop.hpp>

#include "catch.hpp"
#include "hexahedral_scenes.hpp"

namespace soft_hexahedra_surfaces_tests {

using namespace delassus;

TEST_CASE("what lands between the nodes of a bed of hexahedra rests on it, and so does a soft cube") {
  using Soft = HexahedralFem<Corotational>;
  const double h = 0.01, radius = 0.01;
  AnimationLoop loop{World{RigidBodies{}, Soft{}}, Constraints{Contact{Coulomb{.friction = 0.5}}},
                     ImplicitEuler{.rayleigh_stiffness = 0.02},
                     WithSurfaces{NativeCollision{.margin = 0.02}}};
  auto& soft = bodies<Soft>(loop.world());
  auto& rigid = bodies<RigidBodies>(loop.world());
  const auto bed = soft.add({.mesh = hexahedral_box({1, 1, 0.4}, {2, 2, 1}),
                             .elasticity = {.young = 1e5},
                             .contact_radius = radius});
  soft.fix(bed, [](const Vec3& x) { return x[2] < 1e-9; });
  // In the middle of a cell: the nodes around it are 0.25 m away along x and y.
  const auto ball = rigid.add({.position = {0.25, 0.25, 0.53}, .mass = 5., .shape = Sphere{0.1}});
  const auto cube = soft.add({.mesh = hexahedral_box({0.2, 0.2, 0.2}, {1, 1, 1}),
                              .elasticity = {.young = 1e5},
                              .position = {0.65, 0.65, 0.43},
                              .contact_radius = radius,
                              .group = 8,
                              .collides_with = ~8u});
  for (int n = 0; n < 300; ++n) loop.step(h);
  CHECK(loop.report().status == Status::converged);
  CHECK(rigid.position(ball)[2] > 0.45);
  CHECK(rigid.position(ball)[2] < 0.4 + radius + 0.1);
  double on_ball = 0, between = 0;
  for (const ContactResult& c : loop.contacts()) {
    const bool a_is_soft = c.record.a.set == 1, b_is_soft = c.record.b.set == 1;
    (a_is_soft && b_is_soft ? between : on_ball) += std::abs(c.impulse[2]) / h;
  }
  // Damped for 3 s; a hundredth of the weight is more than what still swings.
  CHECK(std::abs(on_ball / (5 * 9.81) - 1) < 1e-2);
  CHECK(std::abs(between / (8 * 9.81) - 1) < 1e-2);  // 0.008 m³ of 1000 kg/m³
  CHECK(soft.position(soft.node(cube, 0))[2] > 0.4);
  // Another world's bodies have the same places and generations. A bed of other cells, under a light ball:
  Soft other;
  other.add({.mesh = hexahedral_box({1, 1, 0.4}, {3, 3, 1}),
             .elasticity = {.young = 1e5},
             .contact_radius = radius});
  soft = other;
  rigid.place(ball, {0.5, 0.5, 0.4 + radius + 0.1 - 1e-4}, Quat::Identity());
  loop.step(h);
  REQUIRE(loop.contacts().size() > 0);
  for (const ContactResult& c : loop.contacts())
    CHECK((c.record.point() - Vec3(0.5, 0.5, 0.4 + radius)).norm() < 0.01);  // its cell is 0.33 m wide
}

}  // namespace soft_hexahedra_surfaces_tests
