// Impacts with what is through by the end of a flight: surfaces without an inside, thin plates.
#include <delassus/collision/with_meshes.hpp>
#include <delassus/loop/located_impacts.hpp>

#include "scenes.hpp"

#include <algorithm>
#include <cmath>
#include <vector>

#include "catch.hpp"

namespace located_through_tests {

using namespace scenes;

TEST_CASE("a box dropped on a height field bounces, flat or leaning, however high it falls from") {
  for (const double h : {0.01, 0.02})
    for (const double lean : {0.0, 0.4})
      for (int n = 0; n < 10; ++n) {
        AnimationLoop loop{World{RigidBodies{}},
                           Constraints{Contact{Restitution{Coulomb{.friction = 0.3}, 0.5}}},
                           ImplicitMidpoint{}, LocatedImpacts{}, WithMeshes{NativeCollision{}}};
        auto& field = loop.template get<WithMeshes<NativeCollision>>();
        auto& set = rigid_bodies(loop);
        set.add_fixed(field.add(HeightField(11, 11, 0.5, 0.5, std::vector<double>(121, 0.0))));
        const auto box = set.add({.position = {0.13 + 0.03 * n, 0.02 - 0.02 * n, 0.5 + 0.3 * n},
                                  .orientation = Quat(Eigen::AngleAxisd(lean, Vec3(1, 2, -1).normalized())),
                                  .mass = 1.0,
                                  .shape = Box{0.3, 0.2, 0.2}});
        double lowest = 1;
        for (int i = 0; i < int(2 / h); ++i) {
          loop.step(h);
          lowest = std::min(lowest, set.position(box)[2]);
        }
        INFO("h " << h << ", lean " << lean << ", drop " << n);
        CHECK(lowest > 0);
      }
}

namespace {

/// A plate of 1 mm about z = 0, without weight, and balls of 5 cm that come down on it.
auto plate(double e) {
  AnimationLoop loop{World{RigidBodies{}}, Constraints{Contact{Restitution{Frictionless{}, e}}},
                     ImplicitMidpoint{}, LocatedImpacts{}, NativeCollision{}};
  auto& set = rigid_bodies(loop);
  set.gravity.setZero();
  set.add({.shape = Box{4, 4, 0.001}, .motion = Motion::fixed});
  return loop;
}
auto drop(auto& loop, double x, double gap, double speed) {
  return rigid_bodies(loop).add(
      {.position = {x, 0.2, 0.0505 + gap}, .velocity = {0, 0, -speed}, .mass = 1.0, .shape = Sphere{0.05}});
}

}  // namespace

// Without a look at what was ahead the ball is 20 cm lower when the step ends, and apart from the plate.
TEST_CASE("a ball that is through a thin plate by the end of a step meets it on the way") {
  for (const double e : {0.0, 0.5, 1.0}) {
    auto loop = plate(e);
    const auto ball = drop(loop, 0.1, 0.01, 20);
    loop.step(0.01);
    // It is at the plate after 0.5 ms and leaves it with e times its speed.
    CHECK(std::abs(rigid_bodies(loop).velocity(ball)[2] - 20 * e) < 1e-12);
    CHECK(std::abs(rigid_bodies(loop).position(ball)[2] - (0.0505 + 20 * e * 0.0095)) < 1e-11);
  }
}

// The hit at the start of the step begins another flight, whose way is looked along as well.
TEST_CASE("a ball meets a thin plate on the way of a flight that began with another ball's hit") {
  auto loop = plate(0.5);
  const auto hits = drop(loop, 1, 0, 2), ball = drop(loop, -1, 0.01, 20);
  loop.step(0.01);
  CHECK(std::abs(rigid_bodies(loop).velocity(hits)[2] - 1) < 1e-12);
  CHECK(std::abs(rigid_bodies(loop).velocity(ball)[2] - 10) < 1e-12);
}

// The slow one overlaps at the end of the step, when the others would be through.
TEST_CASE("balls that would be through a thin plate one after the other meet it, and a slow one does") {
  auto loop = plate(0.5);
  const auto first = drop(loop, -1, 0.01, 20), second = drop(loop, 0, 0.0295, 20),
             slow = drop(loop, 1, 0.018, 2);
  loop.step(0.01);
  CHECK(std::abs(rigid_bodies(loop).velocity(first)[2] - 10) < 1e-12);
  CHECK(std::abs(rigid_bodies(loop).velocity(second)[2] - 10) < 1e-12);
  CHECK(std::abs(rigid_bodies(loop).velocity(slow)[2] - 1) < 1e-12);
}

}  // namespace located_through_tests
