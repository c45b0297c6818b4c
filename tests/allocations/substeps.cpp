#include "allocations/count_allocations.hpp"

#include "allocations/allocation_scenes.hpp"

#include <delassus/schemes/joint_by_joint.hpp>
#include <delassus/schemes/substeps.hpp>

TEST_CASE("a warm step in parts allocates nothing, with impacts that are passed on") {
  AnimationLoop loop{World{RigidBodies{}},
                     Constraints{Contact{SequentialRestitution{Coulomb{.friction = 0.5}, 0.3}}, BallJoint{}},
                     Substeps{3}};
  auto& set = rigid_bodies(loop);
  add_stack(set, 5, Box{1, 1, 1});
  const auto rod =
      set.add({.position = {3, 0, 5}, .velocity = {1, 0, 0}, .mass = 0.2, .shape = Box{0.1, 0.1, 2}});
  loop.add(BallJoint::Item{anchor(set, rod, {0, 0, 1}), world_anchor({3, 0, 6})});
  REQUIRE(allocations_of(loop, 100, 200) == 0);
}

TEST_CASE("a warm step joint by joint allocates nothing, alone and in a chain") {
  for (const int links : {1, 5}) {
    AnimationLoop loop{World{RigidBodies{}}, Constraints{BallJoint{}, Hinge{}}, JointByJoint{.sweeps = 3}};
    auto& set = rigid_bodies(loop);
    Anchor end = world_anchor({0, 0, 0});
    for (int k = 0; k < links; ++k) {
      const auto link = set.add({.position = {0.2 * k + 0.1, 0, 0}, .mass = 1.0, .shape = Box{0.2, 0.05, 0.05}});
      loop.add(BallJoint::Item{end, anchor(set, link, {-0.1, 0, 0})});
      end = anchor(set, link, {0.1, 0, 0});
    }
    REQUIRE(allocations_of(loop, 100, 200) == 0);
  }
}
