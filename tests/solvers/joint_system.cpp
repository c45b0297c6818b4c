// Rotors, springs and stops beside the hinges they turn with, as one block of the direct path.
#include <delassus/constraints/joints/rotor_inertia.hpp>
#include <delassus/constraints/joints/spring_damper.hpp>

#include "direct_tests.hpp"

#include <vector>

namespace joint_system_tests {

using namespace direct_tests;

namespace {

/// Rods of 1 m on hinges along −y, so that all turns are in one plane, each with a rotor and a spring of its
/// own.
template <class Solver>
struct Arm {
  static constexpr int links = 3;
  static constexpr double inertia = 0.7, stiffness = 30, damping = 2, h = 2e-3;

  AnimationLoop<World<RigidBodies>, Constraints<Hinge, Limit<Turn>, SpringDamper<Turn>, RotorInertia<Turn>>,
                Solver>
      loop;
  std::vector<Handle<RigidBodies>> rods;
  std::vector<ConstraintHandle<SpringDamper<Turn>>> springs;
  std::vector<ConstraintHandle<RotorInertia<Turn>>> rotors;

  explicit Arm(Solver solver, double lower)
      : loop{World{RigidBodies{}},
             Constraints{Hinge{}, Limit<Turn>{}, SpringDamper<Turn>{}, RotorInertia<Turn>{}}, solver} {
    auto& set = bodies<RigidBodies>(loop.world());
    const Quat axis = frame_along({0, -1, 0});
    Anchor end = world_anchor(Vec3::Zero(), axis);
    for (int k = 0; k < links; ++k) {
      rods.push_back(set.add({.position = {k + 0.5, 0, 0}, .mass = 1.0 + k, .shape = Box{1, 0.1, 0.1}}));
      const Anchor begin = anchor_at(set, rods.back(), {double(k), 0, 0}, axis);
      loop.add(Hinge::Item{end, begin});
      loop.add(Limit<Turn>::Item{.a = end, .b = begin, .lower = lower});
      springs.push_back(loop.add(
          SpringDamper<Turn>::Item{.a = end, .b = begin, .stiffness = stiffness, .damping = damping}));
      rotors.push_back(loop.add(RotorInertia<Turn>::Item{.a = end, .b = begin, .inertia = inertia}));
      end = anchor_at(set, rods.back(), {k + 1.0, 0, 0}, axis);
    }
  }
  /// Of joint k, rad/s.
  double rate(int k) {
    auto& set = bodies<RigidBodies>(loop.world());
    const double before = k > 0 ? set.angular_velocity(rods[std::size_t(k - 1)]).y() : 0;
    return before - set.angular_velocity(rods[std::size_t(k)]).y();
  }
};

}  // namespace

// The two soft rows of an axis have one H, and share a row: what each of them takes is its own law's answer
// at the rate of the joint,
//   rotor −I (u⁺ − u),   spring −h (k (q + h u⁺) + c u⁺).
// Turns in a plane add up, q⁺ = q + h u⁺. Impulses are of 1e-1 N·m·s, solved to 1e-13 of the largest velocity
// of some 1 m/s.
TEST_CASE("a rotor and a spring on one axis take what their laws say each") {
  Arm arm(DirectGaussSeidel{.tolerance = 1e-10}, -10);
  double q[3] = {}, u[3] = {};
  for (int n = 0; n < 300; ++n) {
    REQUIRE(arm.loop.step(arm.h).status == Status::converged);
    for (int k = 0; k < arm.links; ++k) {
      const double next = arm.rate(k);
      CAPTURE(n, k);
      REQUIRE(std::abs(arm.loop.impulse(arm.rotors[std::size_t(k)])[0] + arm.inertia * (next - u[k])) <=
              1e-9);
      REQUIRE(std::abs(arm.loop.impulse(arm.springs[std::size_t(k)])[0] +
                       arm.h * (arm.stiffness * (q[k] + arm.h * next) + arm.damping * next)) <= 1e-9);
      u[k] = next;
      q[k] += arm.h * next;
    }
  }
  REQUIRE(std::abs(q[0]) > 0.1);  // it moved
}

// Stops at −0.2 rad, which the first joint meets: far ones are left out of the sweeps until they come near.
// Either solver leaves 1e-10 of velocities of some 5 m/s in each step, 5e-10 m over 500 steps of 2e-3 s; a
// stop may be met a step earlier or later by such an error, for which there are two hundred times as much.
TEST_CASE("stops far off and stops that are met move an arm as sweeps over all rows do") {
  Arm direct(DirectGaussSeidel{.tolerance = 1e-10}, -0.2);
  Arm swept(AcceleratedGaussSeidel{.tolerance = 1e-10, .max_iterations = 100000}, -0.2);
  bool met = false;
  for (int n = 0; n < 500; ++n) {
    REQUIRE(direct.loop.step(direct.h).status == Status::converged);
    REQUIRE(swept.loop.step(swept.h).status == Status::converged);
    for (int k = 0; k < direct.links; ++k) {
      const Vec3 x = bodies<RigidBodies>(direct.loop.world()).position(direct.rods[std::size_t(k)]);
      REQUIRE((x - bodies<RigidBodies>(swept.loop.world()).position(swept.rods[std::size_t(k)])).norm() <=
              1e-7);
    }
    met = met || direct.loop.report().sweeps > 0;
  }
  CHECK(met);
}

}  // namespace joint_system_tests
