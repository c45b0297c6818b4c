#include "catch.hpp"

#include <delassus/delassus.hpp>
#include <delassus/fem/elasticity/corotational.hpp>
#include <delassus/fem/rods.hpp>
#include <delassus/fem/tetrahedral_fem.hpp>
#include <delassus/geometry/box_mesh.hpp>

#include <limits>

namespace why_quarantined_soft_tests {

using namespace delassus;

namespace {

const double not_a_number = std::numeric_limits<double>::quiet_NaN();
const double infinity = std::numeric_limits<double>::infinity();

}  // namespace

TEST_CASE("of a soft body and of a rod the node is named that was given the force") {
  using Soft = TetrahedralFem<Corotational>;
  AnimationLoop loop{World{Soft{}, Rods{}}, ImplicitEuler{}};
  auto& soft = bodies<Soft>(loop.world());
  auto& rods = bodies<Rods>(loop.world());
  const auto cube = soft.add({.mesh = box_mesh({1, 1, 1}, {1, 1, 1}), .elasticity = {.young = 1e5, .poisson = 0.3}});
  const auto needle = rods.add({.points = straight_line({0, 0, 3}, {1, 0, 3}, 4), .section = round_section(0.01), .young = 1e9,
                                .density = 1000});
  soft.apply_force(soft.node(cube, 5), {not_a_number, 0, 0});
  REQUIRE(loop.step(0.01).status == Status::quarantined);
  REQUIRE_THAT(why_quarantined(loop), Catch::StartsWith("soft body #0, node #5: the force or torque it was given"));
  rods.apply_torque(rods.node(needle, 3), {0, infinity, 0});
  REQUIRE(loop.step(0.01).status == Status::quarantined);
  REQUIRE_THAT(why_quarantined(loop), Catch::StartsWith("rod #0, node #3: the force or torque it was given"));
}

}  // namespace why_quarantined_soft_tests
