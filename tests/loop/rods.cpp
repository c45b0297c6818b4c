// Rods in contact, and their checkpoints.
#include <delassus/bodies/rigid_bodies.hpp>
#include <delassus/bodies/world.hpp>
#include <delassus/constraints/constraints.hpp>
#include <delassus/constraints/contact/contact.hpp>
#include <delassus/constraints/contact/coulomb.hpp>
#include <delassus/fem/find_rest.hpp>
#include <delassus/integrators/implicit_euler.hpp>
#include <delassus/io/checkpoint.hpp>
#include <delassus/loop/animation_loop.hpp>

#include "catch.hpp"
#include "rod_scenes.hpp"

namespace rods_tests {

using namespace delassus;
using namespace rod_scenes;

namespace {

/// A thread of 20 segments, 1 cm thick, one metre long, `height` above the ground and along x.
auto thread_on_ground(double height, double friction, const Vec3& gravity) {
  AnimationLoop loop{World{RigidBodies{}, Rods{}}, Constraints{Contact{Coulomb{.friction = friction}}},
                     ImplicitEuler{.rayleigh_stiffness = 0.01}};
  auto& rods = bodies<Rods>(loop.world());
  bodies<RigidBodies>(loop.world()).add_fixed(HalfSpace{});
  rods.gravity = gravity;
  rods.add({.points = straight_line({0, 0, 0}, {1, 0, 0}, 20),
            .section = round_section(0.005),
            .young = 1e6,
            .position = {0, 0, height},
            .contact_radius = 0.005});
  return loop;
}
const double weight = 1000 * M_PI * 0.005 * 0.005 * 9.81;

}  // namespace

TEST_CASE("a thread that falls on the ground comes to rest on it, and the ground carries its weight") {
  auto loop = thread_on_ground(0.1, 0.5, {0, 0, -9.81});
  const auto& rods = bodies<Rods>(loop.world());
  for (int n = 0; n < 400; ++n) {
    loop.step(0.005);
    REQUIRE(loop.report().status == Status::converged);
  }
  Vec3 sum = Vec3::Zero();
  for (const auto& c : loop.contacts()) sum += c.impulse / 0.005;
  CHECK(std::abs(std::abs(sum[2]) / weight - 1) < 1e-4);  // it is at rest but for what damping leaves
  for (const Index b : rods.active()) {
    CHECK(std::abs(rods.pose(b).position[2] - 0.005) < 1e-4);
    CHECK(rods.velocity()[b].norm() < 1e-3);
  }
}

TEST_CASE("a thread down a slope sticks below the angle of friction and slides above it") {
  for (const double slope : {0.35, 0.45}) {
    const double angle = std::atan(slope), g = 9.81, mu = 0.4, h = 0.005;
    auto loop = thread_on_ground(0.005, mu, {g * std::sin(angle), 0, -g * std::cos(angle)});
    const auto& rods = bodies<Rods>(loop.world());
    for (int n = 0; n < 200; ++n) loop.step(h);
    const Vec3 v = linear_part(rods.velocity()[10]);
    // a = g (sin − μ cos), and nothing below; what rings in the thread at first is damped.
    const double fast = slope < mu ? 0 : g * (std::sin(angle) - mu * std::cos(angle)) * 200 * h;
    CHECK(std::abs(v[0] - fast) < 1e-3);
    CHECK(v.tail<2>().norm() < 1e-3);
  }
}

TEST_CASE("a ball that rests between two nodes of a rod is carried by both, and presses where it lies") {
  AnimationLoop loop{World{RigidBodies{}, Rods{}}, Constraints{Contact{Coulomb{.friction = 0.5}}},
                     ImplicitEuler{.rayleigh_stiffness = 0.05}};
  auto& rods = bodies<Rods>(loop.world());
  auto& rigid = bodies<RigidBodies>(loop.world());
  // A bridge of four segments, both ends clamped; the ball lies a fifth along the second one.
  const double radius = 0.01, h = 0.002;
  const auto rod = rods.add({.points = straight_line({0, 0, 0}, {1, 0, 0}, 4),
                             .section = round_section(radius),
                             .young = 1e9,
                             .contact_radius = radius});
  rods.gravity.setZero();
  rods.fix(rods.node(rod, 0));
  rods.fix(rods.node(rod, 4));
  rigid.add({.position = {0.3, 0, 0.06}, .mass = 0.1, .shape = Sphere{0.05}});
  Vec3 mean = Vec3::Zero();
  for (int n = 0; n < 100; ++n) {
    loop.step(h);
    REQUIRE(loop.contacts().size() == 1);
    if (n < 50) continue;
    mean += loop.contacts()[0].impulse / (50 * h);
  }
  CHECK(std::abs(loop.contacts()[0].record.point()[0] - 0.3) < 1e-3);
  CHECK(std::abs(std::abs(mean[2]) / 0.981 - 1) < 1e-2);
  // Statics with P shared out by where it is: at node 1 (1 − s) P and at node 2 s P, s = 0.2.
  Rods set;
  set.gravity.setZero();
  const auto still = set.add(
      {.points = straight_line({0, 0, 0}, {1, 0, 0}, 4), .section = round_section(radius), .young = 1e9});
  set.fix(set.node(still, 0));
  set.fix(set.node(still, 4));
  set.apply_force(set.node(still, 1), {0, 0, -0.8 * 0.981});
  set.apply_force(set.node(still, 2), {0, 0, -0.2 * 0.981});
  REQUIRE(find_rest(set).status == Status::converged);
  for (const Index k : {1, 2, 3}) {
    const double sag = set.position(set.node(still, k))[2];
    CHECK(sag < -1e-7);
    CHECK(std::abs(rods.position(rods.node(rod, k))[2] / sag - 1) < 2e-2);
  }
}

TEST_CASE("rods go on bit for bit from a checkpoint, with the same hash of their state") {
  const auto make = [] {
    return AnimationLoop{World{RigidBodies{}, Rods{}}, Constraints{Contact{Coulomb{}}}, ImplicitEuler{}};
  };
  auto loop = make(), restored = make();
  auto& rods = bodies<Rods>(loop.world());
  bodies<RigidBodies>(loop.world()).add_fixed(HalfSpace{});
  Rod rod = bent_rod();
  rod.contact_radius = 0.01;
  rods.add(rod);
  for (int n = 0; n < 20; ++n) loop.step(0.005);
  restore(restored, checkpoint(loop));
  CHECK(state_hash(restored) == state_hash(loop));
  const auto before = state_hash(loop);
  for (int n = 0; n < 20; ++n) loop.step(0.005), restored.step(0.005);
  CHECK(state_hash(restored) == state_hash(loop));
  CHECK(state_hash(loop) != before);
  CHECK(loop.report().contacts > 0);
}

}  // namespace rods_tests
