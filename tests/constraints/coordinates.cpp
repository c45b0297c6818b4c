// The coordinates of free axes: their rates against differences, and turns counted beyond one.
#include <delassus/bodies/rigid_bodies.hpp>
#include <delassus/constraints/joints/coordinate.hpp>
#include <delassus/constraints/joints/drive.hpp>
#include <delassus/constraints/joints/hinge.hpp>
#include <delassus/constraints/joints/motor.hpp>
#include <delassus/loop/animation_loop.hpp>

#include <cmath>
#include <numbers>

#include "catch.hpp"
#include "constraints/poses.hpp"

namespace coordinates_tests {

using namespace delassus;
using namespace poses;

TEMPLATE_TEST_CASE("the row of a free axis is the derivative of its coordinate, in every pose", "", Turn,
                   Slide, Length) {
  each_pair([](int a, int b, Scene& scene) {
    if (a == 2 || a == 3 || (TestType::winds && b == 2)) return;
    const typename Drive<TestType>::Item item{.a = scene.end(a, scene.turn()),
                                              .b = scene.end(b, scene.turn())};
    const Written<Drive<TestType>> rows({}, item, scene.world);
    // θ̇ grows like 1/(1 + a_z · b_z), and its second derivative like the cube: below 0.05 the differences say
    // nothing.
    const double both =
        1 + (scene.world.frame(item.a) * unit_axis(2)).dot(scene.world.frame(item.b) * unit_axis(2));
    if (both < 0.05) return;
    const auto phi = [&] { return Written<Drive<TestType>>({}, item, scene.world).phi; };
    CHECK(difference<1>(scene, rows.H, phi) <= 1e-8 * (1 + std::pow(both, -3)));
  });
}

TEST_CASE("a turn is the twist about the axis, whatever the swing") {
  Scene scene(5);
  for (int n = 0; n < 100; ++n) {
    const double twist = 3.1 * scene.draw();
    const Vec3 across = Vec3{scene.draw(), scene.draw(), 0};
    const Quat turn = exponential<double>(across) * exponential<double>(Vec3(0, 0, twist));
    const JointFrames frames(world_anchor(Vec3::Zero()), world_anchor(Vec3::Zero(), turn), scene.world);
    CHECK(std::abs(Turn::value(frames) - twist) <= 1e-13);  // a dozen roundings, over cos²(|across|/2) > 0.5
  }
}

TEST_CASE("opposite axes leave a finite turn and row") {
  Scene scene(5);
  for (int k = 0; k < 2; ++k) {
    const Drive<Turn>::Item item{
        .a = world_anchor(Vec3::Zero(), exponential<double>(std::numbers::pi * unit_axis(k)) *
                                            scene.set<RigidBodies>().orientation(scene.rigid[0])),
        .b = scene.end(0)};
    const Written<Drive<Turn>> rows({}, item, scene.world);
    CHECK(rows.H.allFinite());
    CHECK(std::isfinite(rows.phi[0]));
  }
}

// 2π · 10 turns in steps of 0.6 rad: every one is less than half a turn.
TEST_CASE("a wheel's angle is counted over its turns") {
  AnimationLoop loop{World{RigidBodies{}}, Constraints{Hinge{}, Motor<Turn>{}}};
  auto& rigid = bodies<RigidBodies>(loop.world());
  rigid.gravity.setZero();
  for (const double sign : {1.0, -1.0}) {
    const auto wheel =
        rigid.add({.angular_velocity = {0, 0, 60 * sign}, .mass = 1.0, .shape = Cylinder{0.1, 0.1}});
    const Anchor axle = anchor(rigid, wheel), ground = world_anchor(Vec3::Zero());
    loop.add(Hinge::Item{ground, axle});
    const auto idle = loop.add(Motor<Turn>::Item{.a = ground, .b = axle, .max_force = 0});
    for (int n = 0; n < 106; ++n) loop.step(0.01);
    // position is that of the start of the last step; the free wheel turns by cay(s θ) a step, θ = 0.6 rad,
    // s = 1 + θ²/12.
    CHECK(std::abs(loop.item(idle).position - sign * 105 * 2 * std::atan(0.3 * (1 + 0.36 / 12))) <= 1e-9);
    CHECK(std::abs(loop.item(idle).position) > 9 * 2 * std::numbers::pi);
  }
}

}  // namespace coordinates_tests
