#include "allocations/count_allocations.hpp"

#include <delassus/bodies/world.hpp>
#include <delassus/collision/native.hpp>
#include <delassus/collision/with_surfaces.hpp>
#include <delassus/constraints/contact/coulomb.hpp>
#include <delassus/integrators/implicit_euler.hpp>
#include <delassus/loop/animation_loop.hpp>

#include "catch.hpp"
#include "cloth_scenes.hpp"

using namespace delassus;

TEST_CASE("a warm step of a sheet that lies on a box allocates nothing") {
  using Sheets = Cloth<Corotational>;
  AnimationLoop loop{World{RigidBodies{}, Sheets{}}, Constraints{Contact{Coulomb{.friction = 0.5}}},
                     ImplicitEuler{.rayleigh_mass = 20, .rayleigh_stiffness = 0.05},
                     WithSurfaces{NativeCollision{}}};
  auto& set = bodies<Sheets>(loop.world());
  bodies<RigidBodies>(loop.world()).add_fixed(Box{0.5, 0.5, 0.1}, {0.5, 0.5, -0.06});
  const auto body =
      set.add({.mesh = sheet(1, 1, {5, 5}, 1e-3), .elasticity = {.young = 1e6}, .contact_radius = 0.01});
  set.fix(body, [](const Vec3& x) { return x[0] < 1e-9 || x[0] > 1 - 1e-9; });
  for (int n = 0; n < 200; ++n) loop.step(0.01);
  REQUIRE(loop.contacts().size() > 3);
  const long before = allocations;
  Eigen::internal::set_is_malloc_allowed(false);
  for (int n = 0; n < 10; ++n) loop.step(0.01);
  Eigen::internal::set_is_malloc_allowed(true);
  REQUIRE(allocations == before);
}
