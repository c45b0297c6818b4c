#include "allocations/count_allocations.hpp"

#include <delassus/bodies/world.hpp>
#include <delassus/integrators/implicit_euler.hpp>
#include <delassus/loop/animation_loop.hpp>

#include "catch.hpp"
#include "hexahedral_scenes.hpp"

using namespace delassus;

TEST_CASE("a warm step of hexahedra allocates nothing") {
  using Soft = HexahedralFem<Corotational>;
  AnimationLoop loop{World{Soft{}}, ImplicitEuler{}};
  auto& soft = bodies<Soft>(loop.world());
  const auto bar = soft.add({.mesh = hexahedral_box({1, 0.2, 0.2}, {5, 1, 1})});
  soft.fix(bar, [](const Vec3& x) { return x[0] < 1e-9; });
  for (int n = 0; n < 2; ++n) loop.step(0.01);
  const long before = allocations;
  Eigen::internal::set_is_malloc_allowed(false);
  for (int n = 0; n < 10; ++n) loop.step(0.01);
  Eigen::internal::set_is_malloc_allowed(true);
  REQUIRE(allocations == before);
}
