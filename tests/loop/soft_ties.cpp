#include "catch.hpp"

#include <delassus/delassus.hpp>
#include <delassus/fem/elasticity/corotational.hpp>
#include <delassus/fem/tetrahedral_fem.hpp>
#include <delassus/geometry/box_mesh.hpp>

namespace soft_ties_tests {

using namespace delassus;

// The points of a soft body move against each other, those of one element too: only a point tied to itself holds nothing.
// Without weight, from rest, the two points go to the length of the joint and stay: implicit Euler damps what swings, and
// what is left is below the solver's 1e-6 of a speed of at most the way in a step.
TEST_CASE("two points of one soft body may be tied, of one element too, and a point to itself may not") {
  using Soft = TetrahedralFem<Corotational>;
  AnimationLoop loop{World{Soft{}}, Constraints{DistanceJoint{}}, ImplicitEuler{}};
  auto& soft = bodies<Soft>(loop.world());
  soft.gravity.setZero();
  const auto cube = soft.add({.mesh = box_mesh({1, 1, 1}, {1, 1, 1}), .elasticity = {.young = 1e5, .poisson = 0.3}, .density = 1000});
  const Anchor a = soft.anchor_at(cube, {0.1, 0.05, 0.05}), b = soft.anchor_at(cube, {0.6, 0.1, 0.1});
  const double length = 0.9 * (soft.point(a) - soft.point(b)).norm();
  REQUIRE(a.element == b.element);
  REQUIRE_THROWS_WITH(loop.add(DistanceJoint::Item{.a = a, .b = a, .length = 0}), Catch::Contains("both ends are on node #"));
  loop.add(DistanceJoint::Item{.a = a, .b = b, .length = length});
  StepReport report;
  for (int n = 0; n < 300; ++n) report = loop.step(0.01);
  CHECK(report.status == Status::converged);
  CHECK((soft.point(a) - soft.point(b)).norm() == Approx(length).epsilon(1e-6));
}

}  // namespace soft_ties_tests
