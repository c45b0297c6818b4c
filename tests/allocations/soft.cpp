#include "allocations/count_allocations.hpp"

#include "allocations/allocation_scenes.hpp"
#include "soft_scenes.hpp"

TEST_CASE("a warm step of a soft cube on the ground, with a rigid body hung from it, allocates nothing") {
  using Soft = TetrahedralFem<Corotational>;
  AnimationLoop loop{World{RigidBodies{}, Soft{}},
                     Constraints{Contact{Coulomb{.friction = 0.5}}, BallJoint{}}, ImplicitEuler{}};
  auto& rigid = bodies<RigidBodies>(loop.world());
  auto& soft = bodies<Soft>(loop.world());
  rigid.add_fixed(HalfSpace{});
  const auto cube = soft.add({.mesh = soft_scenes::cube(3),
                              .elasticity = {.young = 1e5},
                              .position = {0, 0, 0.05},
                              .contact_radius = 0.02});
  const auto weight = rigid.add({.position = {1.5, 0.5, 0.6}, .mass = 5, .shape = Box{0.2, 0.2, 0.2}});
  loop.add(
      BallJoint::Item{soft.anchor_at(cube, {0.9, 0.5, 0.6}), anchor_at(rigid, weight, Vec3(0.9, 0.5, 0.6))});
  // It lands, and with it swing between more and fewer contacts, in the warm part.
  REQUIRE(allocations_of(loop, 60, 100) == 0);
  REQUIRE(loop.report().contacts > 0);
}
