// Parts of tendons whose share is 0 for a while, kinds that there are not, and stops that no turn reaches.
#include <delassus/constraints/joints/rotation_angle.hpp>
#include <delassus/constraints/joints/tendon.hpp>
#include <delassus/delassus.hpp>
#include <delassus/solvers/direct_gauss_seidel.hpp>

#include <limits>
#include <numbers>

#include "catch.hpp"

namespace tendon_parts_tests {

using namespace delassus;
using Catch::Contains;

namespace {

auto make() {
  return AnimationLoop{World{RigidBodies{}}, Constraints{Tendon<2>{}, Limit<RotationAngle>{}},
                       DirectGaussSeidel{.tolerance = 1e-12}};
}

/// Two bodies of 0.2 kg·m² that turn about z, and a tendon of both angles.
struct Two {
  decltype(make()) loop = make();
  RigidBodies& set = bodies<RigidBodies>(loop.world());
  RigidBodies::Handle a, b;

  Two() {
    set.gravity = zero<Vec3>();
    RigidBody body;
    body.mass = 1, body.inertia = Mat3(0.2 * identity<Mat3>());
    a = set.add(body);
    body.position = {2, 0, 0};
    b = set.add(body);
  }
  Tendon<2>::Item item(double share, AxisKind kind = AxisKind::turn) const {
    Tendon<2>::Item item;
    item.parts[0] = {.a = world_anchor({0, 0, 0}), .b = anchor(set, a), .coefficient = 1, .kind = kind};
    item.parts[1] = {.a = world_anchor({2, 0, 0}), .b = anchor(set, b), .coefficient = share, .kind = kind};
    return item;
  }
};

}  // namespace

// q_a + q_b is held: of a turns at 1 rad/s half goes over to b, with the other sign.
TEST_CASE("a part whose share was 0 acts when it gets one") {
  Two scene;
  const auto tendon = scene.loop.add(scene.item(0));
  scene.loop.step(1e-2);
  scene.loop.item(tendon).parts[1].coefficient = 1;
  scene.set.set_velocity(scene.a, zero<Vec3>(), {0, 0, 1});
  scene.loop.step(1e-2);
  CHECK(scene.set.angular_velocity(scene.a)[2] == Approx(0.5));
  CHECK(scene.set.angular_velocity(scene.b)[2] == Approx(-0.5));
}

// At 10 rad/s the midpoint rule turns by (w h)³/12 less in a step; what is read is as it was a step ago.
TEST_CASE("the turns of a part are counted while its share is 0") {
  Two scene;
  const auto tendon = scene.loop.add(scene.item(0));
  scene.set.set_velocity(scene.b, zero<Vec3>(), {0, 0, 10});
  for (int n = 0; n < 100; ++n) scene.loop.step(1e-2);
  CHECK(scene.loop.item(tendon).parts[1].position == Approx(10).margin(10 * 1e-2 + 100 * 1e-3 / 12));
}

TEST_CASE("a tendon goes with the body of a part whose share is 0") {
  Two scene;
  const auto tendon = scene.loop.add(scene.item(0));
  scene.loop.step(1e-2);
  scene.loop.remove(scene.b);
  CHECK_FALSE(scene.loop.contains(tendon));

  Two gone;
  const auto item = gone.item(0);
  gone.loop.remove(gone.b);
  CHECK_THROWS_WITH(gone.loop.add(item), Contains("was removed"));
}

TEST_CASE("a kind of axis that there is not is refused") {
  Two scene;
  CHECK_THROWS_WITH(scene.loop.add(scene.item(1, AxisKind(17))), Contains("kind 17") && Contains("AxisKind"));
  CHECK_THROWS_WITH(scene.loop.add(scene.item(1, AxisKind(-1))), Contains("kind -1"));
}

TEST_CASE("stops that no turn reaches are refused") {
  Two scene;
  const auto stop = [&](double lower, double upper) {
    return Limit<RotationAngle>::Item{
        .a = world_anchor({0, 0, 0}), .b = anchor(scene.set, scene.a), .lower = lower, .upper = upper};
  };
  constexpr double inf = std::numeric_limits<double>::infinity();
  for (const double upper : {-1., -1e-300, 3.5, 1e300})
    CHECK_THROWS_WITH(scene.loop.add(stop(-inf, upper)), Contains("[0, pi]"));
  CHECK_THROWS_WITH(scene.loop.add(stop(3.5, inf)), Contains("must be <= pi"));
  for (const double upper : {0., 1., std::numbers::pi, inf}) CHECK_NOTHROW(scene.loop.add(stop(-inf, upper)));
}

// Nothing answers to the row, in rad/s of a law that turns and in m/s.
TEMPLATE_TEST_CASE("a motor that moves nothing leaves its body free", "", GaussSeidel, DirectGaussSeidel,
                   AcceleratedGaussSeidel) {
  AnimationLoop loop{World{RigidBodies{}},
                     Constraints{TendonMotor<2>{}, Motor<RotationAngle>{}, Motor<Length>{}}, TestType{}};
  auto& set = bodies<RigidBodies>(loop.world());
  RigidBody body;
  body.mass = 1, body.inertia = Mat3(0.2 * identity<Mat3>());
  const auto a = set.add(body);
  body.position = {3, 0, 0};
  const auto b = set.add(body);
  TendonMotor<2>::Item none;
  none.parts[0] = {.a = world_anchor({0, 0, 0}), .b = anchor(set, a), .coefficient = 1};
  none.parts[1] = none.parts[0], none.parts[1].coefficient = -1;
  none.max_force = 3, none.speed = 1;
  loop.add(none);
  loop.add(Motor<RotationAngle>::Item{
      .a = world_anchor({3, 0, 0}), .b = anchor(set, b), .speed = 1, .max_force = 3});
  for (int n = 0; n < 10; ++n) loop.step(1e-2);
  CHECK(set.velocity(a)[2] == Approx(-0.981));
  CHECK(set.velocity(b)[2] == Approx(-0.981));
  CHECK(loop.report().quarantined == 0);
}

}  // namespace tendon_parts_tests
