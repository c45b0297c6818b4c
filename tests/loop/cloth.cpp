// Sheets in the loop: momentum, energy, joints, integrators, builders of W.
#include <delassus/bodies/world.hpp>
#include <delassus/compliance/lazy.hpp>
#include <delassus/constraints/joints/ball_joint.hpp>
#include <delassus/integrators/implicit_euler.hpp>
#include <delassus/loop/animation_loop.hpp>
#include <delassus/steppers/full_newton.hpp>

#include "catch.hpp"
#include "cloth_scenes.hpp"
#include "energy_watch.hpp"

namespace loop_cloth_tests {

using namespace delassus;
using namespace soft_scenes;

using Sheets = Cloth<Corotational>;

namespace {

/// A sheet that flies and spins, bent and let go.
void throw_sheet(Sheets& set) {
  set.gravity.setZero();
  const auto body = set.add({.mesh = square(4, 0.01, 0.2), .elasticity = {.young = 1e5}});
  roll(set, body, 0.8, 0.5);
  for (const Index b : set.active())
    set.velocity()[b] = Vec3(1, 2, 3) + Vec3(0.5, -0.3, 2).cross(set.position(set.handle(b)));
}

}  // namespace

TEST_CASE("implicit Euler keeps the momentum of a sheet, and its energy never rises") {
  AnimationLoop loop{World{Sheets{}}, ImplicitEuler{}};
  auto& set = bodies<Sheets>(loop.world());
  throw_sheet(set);
  const Vec3 P = momentum(set);
  const double first = total_energy(set);
  CHECK(watch_energy(loop, set, 500, 0.002).rise <= 1e-14 * first);
  CHECK((momentum(set) - P).norm() < 1e-12 * P.norm());
}

TEST_CASE("the midpoint rule solved to the end keeps momentum and angular momentum of a sheet") {
  AnimationLoop loop{World{Sheets{}}, FullNewton{.theta = 0.5, .max_iterations = 300}};
  auto& set = bodies<Sheets>(loop.world());
  throw_sheet(set);
  const Vec3 P = momentum(set), L = angular_momentum(set);
  const double first = total_energy(set);
  for (int n = 0; n < 500; ++n) loop.step(0.001);
  CHECK(loop.report().status <= Status::stalled);
  CHECK((momentum(set) - P).norm() < 1e-11 * P.norm());
  CHECK((angular_momentum(set) - L).norm() < 1e-11 * L.norm());
  CHECK(std::abs(total_energy(set) / first - 1) < 1e-3);  // it swings with what rings
}

TEST_CASE("a sheet that hangs by two joints is carried by them, one of them between its nodes") {
  // The same by an old factor that is refined: 1 m² · 1 mm · 500 kg/m³ = 0.5 kg.
  const auto hang = [](auto... parts) {
    AnimationLoop loop{World{Sheets{}}, Constraints{BallJoint{}},
                       ImplicitEuler{.rayleigh_mass = 4, .rayleigh_stiffness = 0.01}, parts...};
    auto& set = bodies<Sheets>(loop.world());
    const auto body = set.add({.mesh = square(5, 1e-3), .elasticity = {.young = 1e6}, .density = 500});
    const auto left =
        loop.add(BallJoint::Item{set.anchor_at(body, {0.05, 0.93, 0}), world_anchor({0.05, 0.93, 0})});
    const auto right = loop.add(BallJoint::Item{anchor(set, set.node(body, 35)), world_anchor({1, 1, 0})});
    for (int n = 0; n < 600; ++n) loop.step(0.01);
    CHECK(loop.report().status == Status::converged);
    const Vec3 carried = (loop.impulse(left) + loop.impulse(right)) / 0.01;
    // Damped for 6 s, what swings is below a hundredth of the weight.
    CHECK((carried.cwiseAbs() - Vec3(0, 0, 0.5 * 9.81)).norm() < 1e-2 * 0.5 * 9.81);
    return set.position(set.node(body, 0));
  };
  const Vec3 exact = hang();
  CHECK(exact[2] < -0.5);
  // Each step is refined to 1e-6 m/s of the joints' velocity, the motion is that of the same A.
  CHECK((hang(LazyCompliance{}) - exact).norm() < 1e-3);
}

}  // namespace loop_cloth_tests
