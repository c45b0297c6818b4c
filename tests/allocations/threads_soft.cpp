// Warm steps of soft bodies by several workers.
#include "allocations/count_allocations.hpp"

#include <delassus/geometry/box_mesh.hpp>

#include "allocations/allocation_scenes.hpp"
#include "in_turns.hpp"
#include "soft_scenes.hpp"

TEST_CASE("a warm step of soft blocks by three workers allocates nothing") {
  using Soft = TetrahedralFem<Corotational>;
  AnimationLoop loop{World{RigidBodies{}, Soft{}},
                     Constraints{Contact{Coulomb{.friction = 0.5}}, BallJoint{}}, ImplicitEuler{}, InTurns{}};
  auto& rigid = bodies<RigidBodies>(loop.world());
  auto& soft = bodies<Soft>(loop.world());
  rigid.add_fixed(HalfSpace{});
  // The first has nodes enough for all, the others are one worker's each.
  for (const Index n : {7, 2, 3}) {
    const auto block = soft.add({.mesh = box_mesh({1, 1, 1}, {n, n, n}),
                                 .elasticity = {.young = 1e5},
                                 .position = {3. * n, 0, 0.05},
                                 .contact_radius = 0.02});
    const Vec3 at(3. * n + 0.9, 0.5, 0.6);
    const auto weight = rigid.add({.position = at + Vec3(0.6, 0, 0), .mass = 5, .shape = Box{0.2, 0.2, 0.2}});
    loop.add(BallJoint::Item{soft.anchor_at(block, at), anchor_at(rigid, weight, at)});
  }
  // They land in the warm-up, and the weights go on swinging.
  REQUIRE(allocations_of(loop, 60, 60) == 0);
  REQUIRE(loop.report().contacts > 50);
}
