// Orders on a soft bar that swings far: elements that turn, and waves that a step resolves.
#include <delassus/fem/elasticity/st_venant_kirchhoff.hpp>
#include <delassus/fem/tetrahedral_fem.hpp>
#include <delassus/geometry/box_mesh.hpp>
#include <delassus/steppers/bdf2.hpp>
#include <delassus/steppers/full_newton.hpp>
#include <delassus/steppers/generalized_alpha.hpp>
#include <delassus/steppers/newmark.hpp>

#include "convergence_order.hpp"
#include "scenes.hpp"

#include "catch.hpp"

namespace soft_orders_tests {

using namespace scenes;

namespace {

/// The sum of the nodes' places of a bar of 1 m after 0.2 s, whose root is held and whose end is thrown at 1
/// m/s.
template <class Integrator>
Vec3 nodes_after(Integrator integrator, double h) {
  using Soft = TetrahedralFem<StVenantKirchhoff>;
  AnimationLoop loop{World{Soft{}}, integrator};
  auto& soft = bodies<Soft>(loop.world());
  const auto bar = soft.add({.mesh = box_mesh({1, 0.2, 0.2}, {4, 1, 1}),
                             .elasticity = {.young = 2e4, .poisson = 0.3},
                             .density = 1000});
  soft.fix(bar, [](const Vec3& x) { return x.x() < 1e-9; });
  for (const Index b : soft.active()) {
    const double x = soft.pose(b).position.x();
    if (soft.moves(b)) soft.velocity()[b] = Vec3(0, 0.3, 1) * x * x;
  }
  for (long n = std::lround(0.2 / h); n > 0; --n) REQUIRE(loop.step(h).status <= Status::stalled);
  Vec3 sum = Vec3::Zero();
  for (const Index b : soft.active()) sum += soft.pose(b).position;
  return sum;
}

/// Errors are measured against a 64th of the largest step, whose own is a 64th of the smallest step's at
/// second order, and an eighth at first.
template <class Integrator>
std::array<double, 2> orders_of(Integrator integrator) {
  const double h = 0.005;
  const Vec3 there = nodes_after(integrator, h / 64);
  return convergence_orders([&](double step) { return (nodes_after(integrator, step) - there).norm(); }, h);
}

}  // namespace

TEST_CASE("a soft bar is met with second order by Newmark, Bdf2, GeneralizedAlpha and FullNewton") {
  for (const auto& orders : {orders_of(Newmark{}), orders_of(Bdf2{}), orders_of(GeneralizedAlpha{}),
                             orders_of(FullNewton{.theta = 0.5})}) {
    CAPTURE(orders[0], orders[1]);
    CHECK(are_of_order(orders, 2));
  }
}

TEST_CASE("a soft bar is met with first order by implicit Euler, by one Newton step and by all of them") {
  for (const auto& orders : {orders_of(ImplicitEuler{}), orders_of(FullNewton{})}) {
    CAPTURE(orders[0], orders[1]);
    CHECK(are_of_order(orders, 1));
  }
}

}  // namespace soft_orders_tests
