#include <delassus/adapters/fcl.hpp>
#include <delassus/io/checkpoint.hpp>

#include "catch.hpp"
#include "scenes.hpp"

using namespace scenes;

namespace {

Standing stand_ten(const Shape& shape) {
  AnimationLoop loop{World{RigidBodies{}}, Constraints{Contact{Coulomb{.friction = 0.5}}}, FclCollision{},
                     AcceleratedGaussSeidel{.tolerance = 1e-6}};
  const auto boxes = add_stack(rigid_bodies(loop), 10, shape);
  return stand(loop, boxes.back());
}

/// The bounds of tests/loop/standing.cpp: they are the solver's, not the backend's.
void check(const Standing& seen) {
  CHECK(seen.unconverged == 0);
  CHECK(seen.drift < 2e-3);
  CHECK(seen.penetration < 5e-4);
  CHECK(seen.kinetic_energy < 1e-8);
}

}  // namespace

TEST_CASE("ten boxes stand for a minute on FCL's contacts") { check(stand_ten(Box{1, 1, 1})); }
TEST_CASE("ten cubes given as points stand for a minute on FCL's contacts") { check(stand_ten(cube_of_points())); }
TEST_CASE("ten cylinders stand for a minute on FCL's contacts") { check(stand_ten(Cylinder{0.5, 1})); }

TEST_CASE("restored into a fresh loop, a stack on FCL's contacts goes on bit for bit") {
  const auto fresh = [] {
    return AnimationLoop{World{RigidBodies{}}, Constraints{Contact{Coulomb{.friction = 0.5}}}, FclCollision{},
                         AcceleratedGaussSeidel{.tolerance = 1e-6}};
  };
  auto loop = fresh();
  add_stack(rigid_bodies(loop), 5, Box{1, 1, 1}, 1e-2);
  for (int n = 0; n < 37; ++n) loop.step(1.0 / 60);
  auto restored = fresh();
  restore(restored, checkpoint(loop));
  for (int n = 0; n < 1000; ++n) {
    loop.step(1.0 / 60);
    restored.step(1.0 / 60);
    REQUIRE(state_hash(loop) == state_hash(restored));
  }
}
