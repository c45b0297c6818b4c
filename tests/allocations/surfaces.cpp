#include "allocations/count_allocations.hpp"

#include <delassus/bodies/world.hpp>
#include <delassus/collision/native.hpp>
#include <delassus/collision/with_surfaces.hpp>
#include <delassus/constraints/contact/frictionless.hpp>
#include <delassus/integrators/implicit_euler.hpp>
#include <delassus/loop/animation_loop.hpp>
#include <delassus/solvers/gauss_seidel.hpp>

#include "catch.hpp"
#include "soft_scenes.hpp"

TEST_CASE(
    "a warm step of a ball between the nodes of a soft cube, and of two such cubes, allocates nothing") {
  using namespace delassus;
  using Soft = TetrahedralFem<Corotational>;
  AnimationLoop loop{World{RigidBodies{}, Soft{}}, Constraints{Contact{Frictionless{}}}, ImplicitEuler{},
                     WithSurfaces{NativeCollision{.margin = 0.02}}, GaussSeidel{}};
  auto& rigid = bodies<RigidBodies>(loop.world());
  auto& soft = bodies<Soft>(loop.world());
  const TetrahedralMesh mesh = box_mesh({1, 1, 0.5}, {2, 2, 1});
  for (const std::uint32_t which : {0u, 1u}) {
    // The second one, turned a little, lies on the first.
    const auto body = soft.add({.mesh = mesh,
                                .elasticity = {.young = 1e5},
                                .density = 100,
                                .position = {0.1 * which, 0.05 * which, 0.52 * which},
                                .orientation = Quat(Eigen::AngleAxisd(0.2 * which, unit_axis(2))),
                                .contact_radius = 0.01,
                                .group = 2u << which,
                                .collides_with = ~(2u << which)});
    if (which == 0) soft.fix(body, [](const Vec3& x) { return x.z() < 1e-9; });
  }
  rigid.add({.position = {0.4, 0.3, 1.14}, .mass = 2, .shape = Sphere{0.1}});
  const auto step = [&](int count) {
    for (int n = 0; n < count; ++n) loop.step(0.01);
  };
  step(250);
  const long before = allocations;
  Eigen::internal::set_is_malloc_allowed(false);
  step(100);
  Eigen::internal::set_is_malloc_allowed(true);
  CHECK(allocations == before);
  // The ball, and the two cubes, hold each other.
  bool has_ball = false, has_cubes = false;
  for (const ContactResult& c : loop.contacts()) {
    const bool is_rigid = c.record.a.set == 0 || c.record.b.set == 0;
    has_ball = has_ball || (is_rigid && c.impulse.norm() > 0);
    has_cubes = has_cubes || (!is_rigid && c.impulse.norm() > 0);
  }
  CHECK(has_ball);
  CHECK(has_cubes);
}
