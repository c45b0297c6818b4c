#include "allocations/count_allocations.hpp"

#include "allocations/allocation_scenes.hpp"

#include <delassus/compliance/lazy.hpp>
#include <delassus/fem/elasticity/corotational.hpp>
#include <delassus/fem/tetrahedral_fem.hpp>
#include <delassus/geometry/box_mesh.hpp>

TEST_CASE("a warm step with a lazy compliance allocates nothing while the contacts stay") {
  using Soft = TetrahedralFem<Corotational>;
  AnimationLoop loop{World{RigidBodies{}, Soft{}}, Constraints{Contact{Coulomb{.friction = 0.5}}},
                     ImplicitEuler{}, LazyCompliance{}};
  bodies<RigidBodies>(loop.world()).add_fixed(HalfSpace{});
  bodies<Soft>(loop.world())
      .add({.mesh = box_mesh({1, 1, 1}, {3, 3, 3}),
            .elasticity = {.young = 1e5},
            .position = {0, 0, 0.02},
            .contact_radius = 0.02});
  REQUIRE(allocations_of(loop, 60, 100) == 0);
  REQUIRE(loop.report().contacts > 0);
}
