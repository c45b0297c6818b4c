// Whole steps of scenes that are large enough for every part of a step to be shared: the bits are those of a
// loop that names no threads, whatever their number.
#include <delassus/collision/with_filter.hpp>
#include <delassus/delassus.hpp>
#include <delassus/fem/elasticity/corotational.hpp>
#include <delassus/fem/tetrahedral_fem.hpp>
#include <delassus/geometry/box_mesh.hpp>
#include <delassus/solvers/coloured.hpp>

#include "catch.hpp"
#include "same_bits.hpp"

namespace same_bits_on_threads_tests {

using namespace same_bits;

TEST_CASE("a pile in one island has the same bits on threads") {
  check_same(
      [](auto... more) {
        AnimationLoop loop{World{RigidBodies{}}, Constraints{Contact{Coulomb{.friction = 0.5}}},
                           Coloured{AcceleratedGaussSeidel{.tolerance = 1e-2}}, more...};
        add_balls(bodies<RigidBodies>(loop.world()), 9, 1);
        return loop;
      },
      30, 5e-3, nothing);
}

TEST_CASE("chains of joints in a heap have the same bits on threads") {
  check_same(
      [](auto... more) {
        AnimationLoop loop{World{RigidBodies{}}, Constraints{Contact{Coulomb{.friction = 0.4}}, BallJoint{}},
                           WithFilter{NativeCollision{}}, Coloured{AcceleratedGaussSeidel{.tolerance = 1e-2}},
                           more...};
        auto& set = bodies<RigidBodies>(loop.world());
        set.add_fixed(HalfSpace{});
        for (int c = 0; c < 60; ++c)
          for (int k = 0; k < 8; ++k) {
            const auto link = set.add({.position = {0.25 * k, 0.19 * (c % 10), 0.1 + 0.19 * (c / 10)},
                                       .mass = 1.0,
                                       .shape = Capsule{0.09, 0.1}});
            if (k > 0)
              loop.add(BallJoint::Item{anchor(set, set.handle(link.index - 1), Vec3(0.125, 0, 0)),
                                       anchor(set, link, Vec3(-0.125, 0, 0))});
          }
        return loop;
      },
      15, 5e-3, nothing);
}

TEST_CASE("a soft body in contact has the same bits on threads") {
  using Soft = TetrahedralFem<Corotational>;
  check_same(
      [](auto... more) {
        AnimationLoop loop{World{RigidBodies{}, Soft{}}, Constraints{Contact{Coulomb{.friction = 0.4}}},
                           ImplicitEuler{}, more...};
        auto& rigid = bodies<RigidBodies>(loop.world());
        rigid.add_fixed(HalfSpace{});
        for (int n = 0; n < 200; ++n)
          rigid.add(
              {.position = {0.3 * (n % 20) - 3, 2 + 0.3 * (n / 20), 0.1}, .mass = 1.0, .shape = Sphere{0.1}});
        bodies<Soft>(loop.world())
            .add({.mesh = box_mesh({1.2, 1.2, 0.4}, {12, 12, 3}),
                  .elasticity = {.young = 1e5},
                  .position = {0, 0, 0.01},
                  .velocity = {0.1, 0, -0.5},
                  .contact_radius = 0.01});
        return loop;
      },
      6, 1e-2, nothing);
}

}  // namespace same_bits_on_threads_tests
