#include "allocations/count_allocations.hpp"

#include "allocations/allocation_scenes.hpp"
#include "rod_scenes.hpp"

TEST_CASE("a warm step of a thread on the ground, with a rigid body hung from it, allocates nothing") {
  AnimationLoop loop{World{RigidBodies{}, Rods{}},
                     Constraints{Contact{Coulomb{.friction = 0.5}}, BallJoint{}},
                     ImplicitEuler{.rayleigh_stiffness = 0.01}};
  auto& rigid = bodies<RigidBodies>(loop.world());
  auto& rods = bodies<Rods>(loop.world());
  rigid.add_fixed(HalfSpace{});
  Rod rod = rod_scenes::bent_rod(12);
  rod.contact_radius = 0.01;
  rod.position = {0, 0, 0.02};
  const auto thread = rods.add(rod);
  const Vec3 end = rods.position(rods.node(thread, 12));
  const auto bead = rigid.add({.position = end, .mass = 0.01, .shape = Sphere{0.01}, .collides_with = 1u});
  loop.add(BallJoint::Item{anchor(rods, rods.node(thread, 12)), anchor(rigid, bead)});
  REQUIRE(allocations_of(loop, 60, 100) == 0);
  REQUIRE(loop.report().contacts > 0);
}
