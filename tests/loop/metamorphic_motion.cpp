#include "metamorphic.hpp"

#include "catch.hpp"

namespace metamorphic_motion_tests {

using namespace metamorphic;

namespace {

constexpr double h = 0.01;

}  // namespace

// A kick and a drift by a step that is a power of two in a world without force: x + h v, rounded once a step.
TEST_CASE("without a force a body drifts by n h v") {
  for (unsigned seed = 1; seed <= seeds(); ++seed) {
    Draw next{std::mt19937(seed)};
    AnimationLoop loop{World{RigidBodies{}, Particles{}}};
    auto& rigid = bodies<RigidBodies>(loop.world());
    auto& dust = bodies<Particles>(loop.world());
    rigid.gravity.setZero(), dust.gravity.setZero();
    const Vec3 x = next.vector(1), v = next.vector(10);
    const auto body = rigid.add(
        {.position = x, .velocity = v, .angular_velocity = next.vector(1), .mass = 2.0, .shape = Sphere{1}});
    const auto grain = dust.add({.position = x, .velocity = v, .mass = 3.0});
    for (int n = 0; n < 1000; ++n) loop.step(1.0 / 128);
    const Vec3 there = x + 1000.0 / 128 * v;
    CAPTURE(seed);
    REQUIRE((rigid.position(body) - there).norm() <= 1000 * 1e-16 * 100);  // 100 m away, half an ulp a step
    REQUIRE((dust.position(grain) - there).norm() <= 1000 * 1e-16 * 100);
    REQUIRE(rigid.velocity(body) == v);
  }
}

// The midpoint rule is its own inverse with −h; two thousand steps round by 1e-16 of a turn each, and its
// Newton iteration ends at the rounding floor.
TEST_CASE("a free body under the midpoint rule comes back when its spin is turned round") {
  for (unsigned seed = 1; seed <= seeds(); ++seed) {
    Draw next{std::mt19937(seed)};
    AnimationLoop loop{World{RigidBodies{}}, ImplicitMidpoint{}};
    auto& set = rigid_bodies(loop);
    const Vec3 spin = next.vector(2), v = next.vector(2);
    const Quat turn = exponential<double>(next.vector(2));
    const auto body = set.add(
        {.orientation = turn, .velocity = v, .angular_velocity = spin, .mass = 1.0, .shape = Box{1, 2, 3}});
    for (int n = 0; n < 1000; ++n) loop.step(h);
    const Vec3 away = set.orientation(body).coeffs().head<3>();
    set.set_velocity(body, -set.velocity(body), -set.angular_velocity(body));
    for (int n = 0; n < 1000; ++n) loop.step(h);
    CAPTURE(seed);
    REQUIRE((away - turn.coeffs().head<3>()).norm() > 1e-3);  // it went somewhere
    REQUIRE(set.position(body).norm() <= 1e-10);
    REQUIRE((set.angular_velocity(body) + spin).norm() <= 1e-10);
    REQUIRE(std::abs(std::abs(set.orientation(body).dot(turn)) - 1) <= 1e-10);
  }
}

TEST_CASE("a particle swings on a rod as a rigid body held at its centre does") {
  for (unsigned seed = 1; seed <= seeds(); ++seed) {
    Draw next{std::mt19937(seed)};
    AnimationLoop loop{World{RigidBodies{}, Particles{}}, Constraints{DistanceJoint{}},
                       AcceleratedGaussSeidel{.tolerance = 1e-14}};
    auto& rigid = bodies<RigidBodies>(loop.world());
    auto& dust = bodies<Particles>(loop.world());
    const Vec3 x = next.vector(1) + Vec3(2, 0, 0), v = next.vector(1);
    const double mass = next(0.1, 10);
    const auto body =
        rigid.add({.position = x, .velocity = v, .mass = mass, .shape = Sphere{0.1}, .collides_with = 0});
    const auto grain = dust.add({.position = x, .velocity = v, .mass = mass});
    loop.add(DistanceJoint::Item{.a = world_anchor({0, 0, 0}), .b = anchor(rigid, body), .length = x.norm()});
    loop.add(DistanceJoint::Item{.a = world_anchor({0, 0, 0}), .b = anchor(dust, grain), .length = x.norm()});
    for (int n = 0; n < 200; ++n) loop.step(h);
    CAPTURE(seed);
    // One row each, met exactly in one sweep: only the rounding of two ways to the same number.
    REQUIRE((rigid.position(body) - dust.position(grain)).norm() <= 1e-12);
    REQUIRE((rigid.position(body) - x).norm() > 0.1);
  }
}

// Only velocities of the one against the other enter a contact. Solves are good to 1e-12 of the speed of the ground, 4 m/s, and what
// tumbles multiplies that by less than 1e6.
TEST_CASE("what falls on ground that moves moves as on ground at rest") {
  std::size_t contacts = 0;
  for (unsigned seed = 1; seed <= 4 * seeds(); ++seed) {
    const auto end = [&](const Vec3& drift) {
      Draw next{std::mt19937(seed)};
      AnimationLoop loop{World{RigidBodies{}}, Constraints{Contact{Restitution{Coulomb{.friction = 0}, 0.0}}}, AcceleratedGaussSeidel{.tolerance = 1e-12}};
      auto& set = bodies<RigidBodies>(loop.world());
      set.add({.velocity = drift, .shape = HalfSpace{}, .motion = Motion::kinematic});
      const Vec3 size = Vec3(0.32, 0.32, 0.32) + next.vector(0.17);
      const auto box = set.add({.position = {0, 0, 0.75 + next.vector(0.2).z()},
                                .orientation = exponential<double>(next.vector(2)),
                                .velocity = next.vector(1) + drift - Vec3(0, 0, 1),
                                .angular_velocity = next.vector(2),
                                .mass = 1.0,
                                .shape = Box{size[0], size[1], size[2]}});
      for (int n = 0; n < 40; ++n) loop.step(1.0 / 60), contacts += loop.contacts().size();
      return std::pair(Vec3(set.velocity(box) - drift), Vec3(set.angular_velocity(box)));
    };
    const auto [v, w] = end(Vec3::Zero());
    const auto [v_moving, w_moving] = end(Vec3(2, -3, 1));
    CAPTURE(seed);
    REQUIRE((v_moving - v).norm() <= 1e-5);
    REQUIRE((w_moving - w).norm() <= 1e-5);
  }
  REQUIRE(contacts >= 20 * seeds());
}

}  // namespace metamorphic_motion_tests
