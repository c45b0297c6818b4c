// Tendons: H is the derivative of the length, sums of joints are held, stopped and driven, ropes run over
// points; angles of ball joints stop.
#include <delassus/constraints/joints/rotation_angle.hpp>
#include <delassus/constraints/joints/serial_joint.hpp>
#include <delassus/constraints/joints/spring_damper.hpp>
#include <delassus/constraints/joints/tendon.hpp>
#include <delassus/delassus.hpp>
#include <delassus/solvers/direct_gauss_seidel.hpp>

#include <algorithm>
#include <cmath>
#include <vector>

#include "catch.hpp"
#include "constraints/poses.hpp"

namespace tendons_tests {

using namespace delassus;
using namespace poses;

namespace {

/// Arms of 1 kg and 1 m on hinges about z, each on the end of the one before; nothing pulls. `laws` act on
/// them.
struct Arms {
  std::vector<RigidBodies::Handle> bodies;
  std::vector<TendonPart> hinges;  ///< coefficient 1

  Arms(auto& loop, int count) {
    auto& set = delassus::bodies<RigidBodies>(loop.world());
    set.gravity = zero<Vec3>();
    for (int k = 0; k < count; ++k) {
      bodies.push_back(set.add(
          {.position = {k + 0.5, 0, 0}, .mass = 1, .inertia = Mat3(Vec3(0.01, 0.1, 0.1).asDiagonal())}));
      const Anchor a =
          k == 0 ? world_anchor(Vec3(0, 0, 0)) : anchor(set, bodies[std::size_t(k) - 1], Vec3(0.5, 0, 0));
      const Anchor b = anchor(set, bodies.back(), Vec3(-0.5, 0, 0));
      loop.add(Hinge::Item{a, b});
      hinges.push_back({.a = a, .b = b, .coefficient = 1, .kind = AxisKind::turn});
    }
  }
  double angle(auto& loop, int k) const {
    TendonPart part = hinges[std::size_t(k)];
    loop.world().resolve(part.a, "test"), loop.world().resolve(part.b, "test");
    return inner::axis_value(part.kind, {part.a, part.b, loop.world()}, 0);
  }
  TendonPart part(int k, double coefficient) const {
    TendonPart part = hinges[std::size_t(k)];
    part.coefficient = coefficient;
    return part;
  }
};

/// Third derivatives of angles of Euler grow near their singularity: to 1e-6 of the largest slope here.
template <class Law>
bool slope_is_right(Scene& scene, const Law& law, const typename Law::Item& item) {
  const auto H = Written<Law>(law, item, scene.world).H;
  const double wrong =
      difference<Law::rows>(scene, H, [&] { return Written<Law>(law, item, scene.world).phi; });
  return wrong < 1e-6 * (1 + std::pow(H.cwiseAbs().maxCoeff(), 2));
}

}  // namespace

TEST_CASE("H of a tendon is the derivative of its length") {
  for (const AxisKind kind : {AxisKind::turn, AxisKind::slide, AxisKind::precession, AxisKind::nutation,
                              AxisKind::spin, AxisKind::length})
    for (unsigned seed = 1; seed <= 5; ++seed) {
      Scene scene(seed);
      Tendon<3>::Item item;
      item.parts[0] = {
          .a = scene.end(0, scene.turn()), .b = scene.end(1, scene.turn()), .coefficient = 0.7, .kind = kind};
      item.parts[2] = {.a = scene.end(1, scene.turn()),
                       .b = scene.end(4, scene.turn()),
                       .coefficient = -1.3,
                       .kind = AxisKind::slide};
      CAPTURE(int(kind), seed);
      CHECK(slope_is_right(scene, Tendon<3>{}, item));
    }
}

// l = q₀ + q₁/2 + q₂/3 of three arms that spin: the row acts on four ends of three bodies.
TEST_CASE("a tendon holds a sum of three hinges") {
  AnimationLoop loop{World{RigidBodies{}}, Constraints{Hinge{}, Tendon<4>{}},
                     DirectGaussSeidel{.tolerance = 1e-12}};
  const Arms arms(loop, 3);
  auto& set = bodies<RigidBodies>(loop.world());
  Tendon<4>::Item item;
  for (int k = 0; k < 3; ++k) item.parts[std::size_t(k)] = arms.part(k, 1. / (k + 1));
  loop.add(item);
  double most = 0, turned = 0;
  for (int n = 0; n < 400; ++n) {
    set.apply_torque(arms.bodies[2], {0, 0, 0.3});
    loop.step(5e-3);
    double length = 0;
    for (int k = 0; k < 3; ++k)
      length += arms.angle(loop, k) / (k + 1), turned = std::max(turned, std::abs(arms.angle(loop, k)));
    most = std::max(most, std::abs(length));
  }
  CHECK(turned > 0.5);
  CHECK(most < 1e-6);  // rad: the solver leaves 1e-12 rad/s a step
}

// A spring of the sum and a constant moment: k l = M c at rest.
TEST_CASE("a tendon is a spring and stops where it is limited") {
  for (const bool is_limited : {false, true}) {
    AnimationLoop loop{World{RigidBodies{}},
                       Constraints{Hinge{}, Tendon<2>{}, TendonLimit<2>{}, SpringDamper<Turn>{}},
                       DirectGaussSeidel{.tolerance = 1e-12}};
    const Arms arms(loop, 2);
    auto& set = bodies<RigidBodies>(loop.world());
    loop.add(Tendon<2>::Item{
        .parts = {arms.part(0, 1), arms.part(1, -2)}, .rest = 0.1, .stiffness = 3, .damping = 2});
    for (int k = 0; k < 2; ++k)
      loop.add(SpringDamper<Turn>::Item{.a = arms.hinges[std::size_t(k)].a,
                                        .b = arms.hinges[std::size_t(k)].b,
                                        .stiffness = k == 0 ? 0. : 5,
                                        .damping = 2.4});
    if (is_limited)
      loop.add(TendonLimit<2>::Item{.parts = {arms.part(0, 1), arms.part(1, -2)}, .lower = -1, .upper = 0.2});
    for (int n = 0; n < 6000; ++n) {
      set.apply_torque(arms.bodies[0], {0, 0, 0.6});  // on the first hinge alone
      loop.step(5e-3);
    }
    const double length = arms.angle(loop, 0) - 2 * arms.angle(loop, 1);
    // On the second hinge: 5 q₁ = −2 · (−force of the tendon), which is the moment of the first.
    CHECK(arms.angle(loop, 1) == Approx(2 * 0.6 / 5).margin(1e-6));
    CHECK(length == Approx(is_limited ? 0.2 : 0.1 + 0.6 / 3).margin(1e-6));
  }
}

// The force on the length, 0.5 N·m, makes a moment of 2 · 0.5 on a hinge of coefficient 2.
TEST_CASE("a tendon's motor pulls with its cap and no more") {
  AnimationLoop loop{World{RigidBodies{}}, Constraints{Hinge{}, TendonMotor<2>{}},
                     DirectGaussSeidel{.tolerance = 1e-12}};
  const Arms arms(loop, 1);
  auto& set = bodies<RigidBodies>(loop.world());
  const auto motor = loop.add(TendonMotor<2>::Item{.parts = {arms.part(0, 2)}, .max_force = 0.5});
  for (int n = 0; n < 100; ++n)
    set.apply_torque(arms.bodies[0], {0, 0, 0.9}), loop.step(1e-2);  // dry friction holds it
  CHECK(std::abs(arms.angle(loop, 0)) < 1e-9);
  CHECK(loop.impulse(motor)[0] == Approx(-0.45e-2).epsilon(1e-9));
  for (int n = 0; n < 100; ++n) set.apply_torque(arms.bodies[0], {0, 0, 1.1}), loop.step(1e-2);
  CHECK(arms.angle(loop, 0) ==
        Approx(0.1 / (2 * 0.35) * 1.01).epsilon(1e-4));  // ½ M t²/(I + m l²), and half a step of it
  loop.item(motor).stiffness = 1e4, loop.item(motor).target = -9;
  loop.step(1e-3);
  CHECK(loop.impulse(motor)[0] == Approx(-0.5e-3).epsilon(1e-12));
}

// From a post over the first body's point to the second: the spring of a rope pulls with one force all along.
TEST_CASE("a rope over a point pulls with one tension") {
  AnimationLoop loop{World{RigidBodies{}}, Constraints{Tendon<2>{}}, DirectGaussSeidel{.tolerance = 1e-12}};
  auto& set = bodies<RigidBodies>(loop.world());
  set.gravity = zero<Vec3>();
  const auto one = set.add({.position = {1, 0, 0}, .mass = 1, .inertia = identity<Mat3>()}),
             other = set.add({.position = {1, 2, 0}, .mass = 2, .inertia = identity<Mat3>()});
  loop.add(Tendon<2>::Item{.parts = {TendonPart{.a = world_anchor(Vec3(0, 0, 0)),
                                                .b = anchor(set, one),
                                                .coefficient = 1,
                                                .kind = AxisKind::length},
                                     TendonPart{.a = anchor(set, one),
                                                .b = anchor(set, other),
                                                .coefficient = 1,
                                                .kind = AxisKind::length}},
                           .rest = 2,
                           .stiffness = 10});
  loop.step(1e-6);
  const double impulse = 10 * 1e-6;  // 1 m too long; how it moves in the step is of order 1e-11
  CHECK(norm(Vec3(set.velocity(one) - impulse * Vec3(-1, 1, 0))) < 1e-15);
  CHECK(norm(Vec3(set.velocity(other) - impulse / 2 * Vec3(0, -1, 0))) < 1e-15);
}

TEST_CASE("a tendon refuses what it cannot be") {
  AnimationLoop loop{World{RigidBodies{}},
                     Constraints{Hinge{}, Tendon<2>{}, TendonLimit<2>{}, TendonMotor<2>{}}};
  const Arms arms(loop, 2);
  CHECK_THROWS_WITH(loop.add(Tendon<2>::Item{}), Catch::Contains("no part has a coefficient"));
  CHECK_THROWS_WITH(loop.add(Tendon<2>::Item{.parts = {arms.part(0, NAN)}}),
                    Catch::Contains("Tendon: coefficient"));
  CHECK_THROWS_WITH(loop.add(Tendon<2>::Item{.parts = {arms.part(0, 1)}, .stiffness = -1}),
                    Catch::Contains("Tendon: stiffness"));
  CHECK_THROWS_WITH(loop.add(TendonLimit<2>::Item{.parts = {arms.part(0, 1)}, .lower = 2, .upper = 1}),
                    Catch::Contains("lower 2"));
  CHECK_THROWS_WITH(loop.add(TendonMotor<2>::Item{.parts = {arms.part(0, 1)}, .max_force = -1}),
                    Catch::Contains("max_force"));
  TendonPart nowhere{.a = world_anchor(Vec3(0, 0, 0)),
                     .b = world_anchor(Vec3(1, 0, 0)),
                     .coefficient = 1,
                     .kind = AxisKind::length};
  CHECK_THROWS_WITH(loop.add(Tendon<2>::Item{.parts = {arms.part(0, 1), nowhere}}),
                    Catch::Contains("both ends are in the world"));
}

// Bodies leave with their tendons.
TEST_CASE("a tendon goes with any of its bodies") {
  AnimationLoop loop{World{RigidBodies{}}, Constraints{Hinge{}, Tendon<3>{}}};
  const Arms arms(loop, 3);
  const auto tendon = loop.add(Tendon<3>::Item{.parts = {arms.part(0, 1), arms.part(1, 1), arms.part(2, 1)}});
  int joints = 0;
  loop.each_joint([&](const Anchor&, const Anchor&) { ++joints; });
  CHECK(joints == 6);
  loop.remove(arms.bodies[2]);
  CHECK_FALSE(loop.contains(tendon));
}

TEST_CASE("H of the limit of a ball joint is the derivative of its angle") {
  for (unsigned seed = 1; seed <= 10; ++seed) {
    Scene scene(seed);
    const Limit<RotationAngle>::Item item{.a = scene.end(0, scene.turn()),
                                          .b = scene.end(1, scene.turn()),
                                          .lower = -10,
                                          .upper = 10,
                                          .margin = 20};
    CAPTURE(seed);
    CHECK(slope_is_right(scene, Limit<RotationAngle>{}, item));
  }
}

// A top on a ball joint is turned by lean and twist together; it is stopped at 0.5 rad in all.
TEST_CASE("a ball joint stops at its largest angle") {
  AnimationLoop loop{World{RigidBodies{}}, Constraints{BallJoint{}, Limit<RotationAngle>{}},
                     DirectGaussSeidel{.tolerance = 1e-12}};
  auto& set = bodies<RigidBodies>(loop.world());
  const auto top = set.add({.position = {0, 0, 0.3}, .mass = 1, .inertia = Mat3(0.1 * identity<Mat3>())});
  const Anchor a = world_anchor(Vec3(0, 0, 0)), b = anchor(set, top, Vec3(0, 0, -0.3));
  loop.add(BallJoint::Item{a, b});
  loop.add(Limit<RotationAngle>::Item{.a = a, .b = b, .upper = 0.5});
  set.set_velocity(top, Vec3(0.3, 0, 0), Vec3(0, 1, 1));
  double most = 0;
  for (int n = 0; n < 3000; ++n) {
    loop.step(1e-3);
    const Quat q = set.orientation(top);
    most = std::max(most, 2 * std::atan2(norm(Vec3(q.x(), q.y(), q.z())), std::abs(q.w())));
  }
  CHECK(most > 0.499);
  CHECK(most < 0.501);
}

}  // namespace tendons_tests
