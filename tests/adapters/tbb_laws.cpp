// Laws, integrators and schemes on several threads: the same bits at any number of them.
#include <delassus/activity/sleeping.hpp>
#include <delassus/constraints/joints/hinge.hpp>
#include <delassus/delassus.hpp>
#include <delassus/integrators/implicit_midpoint.hpp>
#include <delassus/schemes/substeps.hpp>

#include "catch.hpp"
#include "scenes.hpp"
#include "tbb_scenes.hpp"

namespace tbb_laws_tests {

using namespace delassus;
using namespace scenes;
using namespace tbb_scenes;

TEST_CASE("bounces, joints with limits and another law of contacts: the same bits by any number of threads") {
  check_same_bits(100, 1. / 100, [](auto make, auto run) {
    auto loop = make(World{RigidBodies{}}, Constraints{Contact{Restitution{Coulomb{.friction = 0.3}, 0.5}},
                                                       BallJoint{}, Limit<Turn>{}, Hinge{}});
    auto& set = rigid_bodies(loop);
    set.add_fixed(HalfSpace{});
    for (int i = 0; i < 40; ++i) {
      const Vec3 at(4. * i, 0, 0.6 + 0.01 * i);
      const auto a = set.add(
          {.position = at, .angular_velocity = {0, 1. + i, 0}, .mass = 1., .shape = Box{1, 0.5, 0.5}});
      const auto b = set.add({.position = at + Vec3(1.2, 0, 0.3), .mass = 0.5, .shape = Capsule{0.2, 0.6}});
      if (i % 2)
        loop.add(BallJoint::Item{anchor(set, a, {0.6, 0, 0.15}), anchor(set, b, {-0.6, 0, -0.15})});
      else
        loop.add(Hinge::Item{anchor(set, a, {0.6, 0, 0.15}), anchor(set, b, {-0.6, 0, -0.15})});
    }
    return run(loop);
  });
}

TEST_CASE("the midpoint rule, sleep and substeps: the same bits by any number of threads") {
  check_same_bits(100, 1. / 100, [](auto make, auto run) {
    auto loop = make(World{RigidBodies{}}, Constraints{Contact{Coulomb{.friction = 0.3}}, BallJoint{}},
                     ImplicitMidpoint{});
    auto& set = rigid_bodies(loop);
    add_stacks(set, 10);
    for (int i = 0; i < 10; ++i) {
      const auto rod = set.add({.position = {3. * i, 5, 3},
                                .angular_velocity = {0, 0, 1. * i},
                                .mass = 1.,
                                .shape = Box{1, 0.2, 0.2}});
      loop.add(BallJoint::Item{anchor(set, rod, {-0.5, 0, 0}), world_anchor({3. * i - 0.5, 5, 3})});
    }
    return run(loop);
  });
  check_same_bits(150, 1. / 60, [](auto make, auto run) {
    auto loop = make(World{RigidBodies{}}, Constraints{Contact{Coulomb{.friction = 0.6}}}, Sleeping{});
    add_stacks(rigid_bodies(loop), 8);
    return run(loop);
  });
  check_same_bits(30, 1. / 30, [](auto make, auto run) {
    auto loop =
        make(World{RigidBodies{}}, Constraints{Contact{Coulomb{.friction = 0.6}}}, Substeps{.count = 4});
    add_stacks(rigid_bodies(loop), 8);
    return run(loop);
  });
}

}  // namespace tbb_laws_tests
