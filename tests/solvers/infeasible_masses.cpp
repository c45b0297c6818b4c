// Whether rows contradict each other is no matter of masses, nor of their unit.
#include <delassus/solvers/proximal_newton.hpp>

#include "scenes.hpp"

#include "catch.hpp"

namespace infeasible_masses_tests {

using namespace scenes;

namespace {

constexpr double h = 0.01;

Mat3 ball_inertia(double mass) { return 0.1 * mass * Mat3::Identity(); }

}  // namespace

// A rod of r kg holds 1 kg under the ceiling. λ = h m g moves the rod as r⁻¹ would: what λ is as a number
// rounds the rod's velocity at its ends by at most 8 ε h g/r, ε = 2.2e-16, twice r⁻¹ and ten times r⁻¹ for
// its turn: u ≤ 8 · 12 ε h g/r = 2e-3 m/s at r = 1e-12. The position solve has the same rounding. Two such
// gaps are 2 h u = 4e-5 m; without them h² v²/2 l = 3e-6 m is what a step along the tangent leaves. Rows
// called contradictory yield by a tenth of themselves: h g/10 a step, 0.05 m/s in 5 steps.
TEMPLATE_TEST_CASE("a rod without mass that holds a ball contradicts nothing", "", AcceleratedGaussSeidel,
                   ProximalNewton) {
  for (const double ratio : {1e-9, 1e-10, 1e-11, 1e-12})
    for (const double unit : {1.0, 1e-6, 1e6})
      for (int draw = 0; draw < 3; ++draw) {
        AnimationLoop loop{World{RigidBodies{}}, Constraints{BallJoint{}}, TestType{.tolerance = 1e-8},
                           PositionProjection{.rate = 1}};
        auto& set = rigid_bodies(loop);
        const auto light =
            set.add({.position = {0, 0, -1}, .mass = ratio * unit, .inertia = ball_inertia(ratio * unit)});
        const auto heavy = set.add({.position = {0, 0, -2}, .mass = unit, .inertia = ball_inertia(unit)});
        loop.add(BallJoint::Item{world_anchor({0, 0, 0}), anchor(set, light, {0, 0, 1})});
        loop.add(BallJoint::Item{anchor(set, light, {0, 0, -1}), anchor(set, heavy)});
        set.set_velocity(heavy, {0.5 * (1 + 1e-9 * draw), 0, 0});
        for (int n = 0; n < 20; ++n) {
          CAPTURE(ratio, unit, draw, n);
          const StepReport r = loop.step(h);
          REQUIRE(r.status < Status::infeasible);
          REQUIRE(r.max_joint_violation < 4.5e-5);
        }
      }
}

// Two rods of different lengths between the same points; on the other body, which one joint ties to theirs,
// they have no hold.
TEMPLATE_TEST_CASE("rods that contradict each other are told whatever hangs on their body", "",
                   AcceleratedGaussSeidel, ProximalNewton) {
  for (const double mass : {1e-12, 1e-8, 1e-4, 1.0, 1e4, 1e8, 1e12})
    for (const double unit : {1.0, 1e-7})
      for (const bool is_lower : {false, true}) {
        AnimationLoop loop{World{RigidBodies{}}, Constraints{BallJoint{}, DistanceJoint{}}, TestType{}};
        auto& set = rigid_bodies(loop);
        const auto upper =
            set.add({.position = {0, 0, -1}, .mass = mass * unit, .inertia = ball_inertia(mass * unit)});
        const auto lower = set.add({.position = {0, 0, -2}, .mass = unit, .inertia = ball_inertia(unit)});
        loop.add(BallJoint::Item{anchor(set, upper), anchor(set, lower, {0, 0, 1})});
        for (const double length : {1.0, 2.0})
          loop.add(DistanceJoint::Item{world_anchor({0, 0, is_lower ? -0.5 : 0.5}),
                                       anchor(set, is_lower ? lower : upper), length});
        // The rods pull and push by 0.2 × 0.5 m/h at most.
        for (int n = 0; n < 5; ++n) {
          CAPTURE(mass, unit, is_lower, n);
          const Status status = loop.step(h).status;
          REQUIRE(status == Status::infeasible);
          REQUIRE(set.velocity(is_lower ? lower : upper).norm() < 0.2 * 0.5 / h);
        }
      }
}

// Standing on a light box, which sweeps do not get through: rows agree.
TEST_CASE("a heavy box on a light one is no contradiction at any ratio of masses") {
  for (const double heavy : {1e10, 1e12, 1e14}) {
    AnimationLoop loop{World{RigidBodies{}}, Constraints{Contact{Coulomb{.friction = 0.5}}},
                       AcceleratedGaussSeidel{}};
    auto& set = rigid_bodies(loop);
    set.add_fixed(HalfSpace{});
    set.add({.position = {0, 0, 0.5}, .mass = 1.0, .shape = Box{1, 1, 1}});
    set.add({.position = {0, 0, 1.5}, .mass = heavy, .shape = Box{1, 1, 1}});
    for (int n = 0; n < 3; ++n) {
      CAPTURE(heavy, n);
      REQUIRE(loop.step(h).status < Status::infeasible);
    }
  }
}

}  // namespace infeasible_masses_tests
