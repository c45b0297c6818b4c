// Rigid bodies that joints hold under the midpoint rule, from round to as slender as a needle.
#include <delassus/bodies/anchor_at.hpp>
#include <delassus/bodies/invariants.hpp>
#include <delassus/bodies/rigid_bodies.hpp>
#include <delassus/bodies/world.hpp>
#include <delassus/constraints/joints/ball_joint.hpp>
#include <delassus/constraints/joints/cylindrical.hpp>
#include <delassus/constraints/joints/hinge.hpp>
#include <delassus/integrators/implicit_midpoint.hpp>
#include <delassus/loop/animation_loop.hpp>
#include <delassus/math/rotation.hpp>
#include <delassus/solvers/direct_gauss_seidel.hpp>
#include <delassus/stabilisation/baumgarte.hpp>
#include <delassus/stabilisation/position_projection.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

#include "catch.hpp"
#include "convergence_order.hpp"

namespace held_turns_tests {

using namespace delassus;

namespace {

const std::array ratios{1.0, 1e-1, 1e-2, 1e-3, 1e-4, 1e-5, 1e-6, 1e-7};  // of the moments of inertia

Mat3 moments(double x, double y, double z) { return Vec3(x, y, z).asDiagonal(); }

auto make() {
  return AnimationLoop{World{RigidBodies{}}, Constraints{Hinge{}, BallJoint{}, Cylindrical{}}, ImplicitMidpoint{},
                       PositionProjection{.rate = 1}, DirectGaussSeidel{}};
}

struct Found {
  Vec3 place;
  double gap = 0, gain = 0;  // m or rad, of J
};
/// What one of the bodies does in `time`; the first step may begin with what is not known to the joints.
Found run(auto& loop, const RigidBodies& set, RigidBodies::Handle body, double h, double time) {
  Found found;
  const double start = kinetic_energy(set) + potential_energy(set);
  for (int n = 0; n < std::lround(time / h); ++n) {
    const StepReport report = loop.step(h);
    REQUIRE(report.status == Status::converged);
    found.gap = std::max(found.gap, report.max_joint_violation);
    found.gain = std::max(found.gain, std::abs(kinetic_energy(set) + potential_energy(set) - start));
  }
  found.place = set.position(body);
  return found;
}

/// A rod of half a metre, z along it, which is let go 30° below the level; on a hinge about y, or on a ball joint and pushed
/// aside.
Found swing(double ratio, double h, bool is_on_hinge) {
  auto loop = make();
  auto& set = bodies<RigidBodies>(loop.world());
  const Quat turn = exponential<double>({0, std::numbers::pi / 2 + std::numbers::pi / 6, 0});
  const Vec3 middle = turn * Vec3(0, 0, 0.25), rate = is_on_hinge ? Vec3(0, 0, 0) : Vec3(middle.cross(Vec3(0, 1, 0)) * 4);
  const auto rod = set.add({.position = middle,
                            .orientation = turn,
                            .velocity = rate.cross(middle),
                            .angular_velocity = rate,
                            .mass = 5,
                            .inertia = moments(0.1, 0.1, 0.1 * ratio)});
  const Quat axis = frame_along({0, 1, 0});
  if (is_on_hinge)
    loop.add(Hinge::Item{world_anchor(Vec3::Zero(), axis), anchor_at(set, rod, Vec3::Zero(), axis)});
  else
    loop.add(BallJoint::Item{world_anchor(Vec3::Zero()), anchor_at(set, rod, Vec3::Zero())});
  return run(loop, set, rod, h, 1);
}

}  // namespace

// What turns about the rod takes no part: the rod does what a round one does that has I = 0.1 kg·m² across, but for what the
// joint's turn leaves to it. A step opens a joint by h³ α ω r/4 at most, which its displacement closes but for h ω/2 of it: with
// ω < 7 rad/s, α < 30 rad/s² and r = 0.25 m 6e-9 m at h = 1 ms, of a rod of 0.5 m.
TEST_CASE("a rod keeps its hinge and its swing however slender it is") {
  const Found round = swing(1, 1e-3, true);
  for (const double ratio : ratios) {
    const Found rod = swing(ratio, 1e-3, true);
    CAPTURE(ratio, rod.gap, rod.gain);
    CHECK(rod.gap <= 1e-6 * 0.5);
    CHECK((rod.place - round.place).norm() <= 1e-6);
    CHECK(rod.gain <= 1e-4 * 5 * 9.81 * 0.25);
  }
}

// Out of a plane too, where the moment of a joint turns against the rod within a step. About the rod it has no momentum at first, and
// gets none: its path is that of a rod without a moment of inertia there, up to the ratio and to h².
TEST_CASE("a rod on a ball joint swings aside as it would without a thin axis") {
  for (const double h : {1e-2, 1e-3}) {
    const Found thinnest = swing(1e-7, h, false);
    for (const double ratio : ratios) {
      const Found rod = swing(ratio, h, false);
      CAPTURE(h, ratio, rod.gap, rod.gain, (rod.place - thinnest.place).norm());
      CHECK(rod.gap <= 5 * h * h * h);
      CHECK((rod.place - thinnest.place).norm() <= ratio + 5 * h * h);
      CHECK(rod.gain <= 50 * h * h * 5 * 9.81 * 0.25);
    }
  }
}

// Three rods in a chain that swings out of a plane: each pulls at the ends of the next.
TEST_CASE("a chain of needles keeps its ball joints") {
  for (const double ratio : {1.0, 1e-3, 1e-7}) {
    auto loop = make();
    auto& set = bodies<RigidBodies>(loop.world());
    const double h = 2e-3;
    const Vec3 rate(0, 0.5, 0.2);
    Anchor last = world_anchor(Vec3::Zero());
    RigidBodies::Handle rod;
    for (int k = 0; k < 3; ++k) {
      const Vec3 middle(0.5 + k, 0, 0);
      rod = set.add({.position = middle,
                     .velocity = rate.cross(middle),
                     .angular_velocity = rate,
                     .mass = 1,
                     .inertia = moments(ratio / 12, 1. / 12, 1. / 12)});
      loop.add(BallJoint::Item{last, anchor(set, rod, {-0.5, 0, 0})});
      last = anchor(set, rod, {0.5, 0, 0});
    }
    const Found found = run(loop, set, rod, h, 1);
    CAPTURE(ratio, found.gap, found.gain);
    CHECK(found.gap <= 1e-6);
    CHECK(found.gain <= 1e-3);  // of 3 · 9.81 · 1.5 J
  }
}

// No force acts and no joint does work. At h ω = 6e-3 the rule's own energy swings by (h ω)² = 3.6e-5 of itself.
TEST_CASE("a slider-crank of needles keeps its energy") {
  for (const double ratio : {1.0, 1e-4, 1e-7}) {
    auto loop = make();
    auto& set = bodies<RigidBodies>(loop.world());
    set.gravity.setZero();
    const double r = 0.2, l = 0.6, omega = 6, speed = r * omega, h = 1e-3;
    const double I = r * r / 12, J = 0.5 * l * l / 12;
    const auto crank = set.add({.position = {r / 2, 0, 0}, .velocity = {0, speed / 2, 0}, .angular_velocity = {0, 0, omega}, .mass = 1, .inertia = moments(ratio * I, I, I)});
    const auto rod = set.add({.position = {r + l / 2, 0, 0}, .velocity = {0, speed / 2, 0}, .angular_velocity = {0, 0, -speed / l}, .mass = 0.5, .inertia = moments(ratio * J, J, J)});
    const auto piston = set.add({.position = {r + l, 0, 0}, .mass = 0.8, .inertia = moments(1e-3, 1e-3, 1e-3)});
    const Quat rail = frame_along({1, 0, 0});
    loop.add(Hinge::Item{world_anchor(Vec3::Zero()), anchor(set, crank, {-r / 2, 0, 0})});
    loop.add(Hinge::Item{anchor(set, crank, {r / 2, 0, 0}), anchor(set, rod, {-l / 2, 0, 0})});
    loop.add(BallJoint::Item{anchor(set, rod, {l / 2, 0, 0}), anchor(set, piston)});
    loop.add(Cylindrical::Item{world_anchor(Vec3::Zero(), rail), anchor(set, piston, Vec3::Zero(), rail)});
    const double start = kinetic_energy(set);
    const Found found = run(loop, set, piston, h, 1.5);
    CAPTURE(ratio, found.gap, found.gain / start);
    CHECK(found.gap <= 1e-6 * r);
    CHECK(found.gain <= 3.6e-5 * start);
  }
}

namespace {

/// Where a heavy top that spins at 60 rad/s is after half a second.
Vec3 top(int steps) {
  auto loop = make();
  auto& set = bodies<RigidBodies>(loop.world());
  const Quat turn = exponential<double>({0, 0.5, 0});
  const Vec3 arm = turn * Vec3(0, 0, 0.1), spin = turn * Vec3(0, 0, 60);
  const auto body = set.add({.position = arm, .orientation = turn, .angular_velocity = spin, .mass = 1, .inertia = moments(2e-3, 2e-3, 1e-3)});
  loop.add(BallJoint::Item{world_anchor(Vec3::Zero()), anchor_at(set, body, Vec3::Zero())});
  return run(loop, set, body, 0.5 / steps, 0.5).place;
}

}  // namespace

// Where a joint saw the mean of the velocities before and after the impulses, without what the gyroscopic term adds in the step,
// the top was of first order.
TEST_CASE("a heavy top on a ball joint is of second order under the midpoint rule") {
  const Vec3 fine = top(16000);
  std::array<double, 3> error{};
  for (int k = 0; k < 3; ++k) error[std::size_t(k)] = (top(500 << k) - fine).norm();
  CAPTURE(error[0], error[1], error[2]);
  CHECK(error[0] <= 1e-4);
  for (int k = 0; k < 2; ++k) {
    const double order = convergence_order(error[std::size_t(k)], error[std::size_t(k) + 1]);
    CHECK((order >= 1.85 && order <= 2.3));
  }
}

// Two bodies that are no needles have no moment but that of each other, whatever is left of the guess of the middle; displacements
// alone move what a joint has opened, by h² of it.
TEST_CASE("two bodies on a ball joint keep their angular momentum under the midpoint rule") {
  AnimationLoop loop{World{RigidBodies{}}, Constraints{BallJoint{}}, ImplicitMidpoint{}, Baumgarte{}, DirectGaussSeidel{}};
  auto& set = bodies<RigidBodies>(loop.world());
  set.gravity.setZero();
  const Vec3 left(1, 2, -1), right(3, -1, 1.5), arm(0.5, 0, 0);
  const auto a = set.add({.position = -arm, .velocity = left.cross(-arm), .angular_velocity = left, .mass = 1, .inertia = moments(0.05, 0.1, 0.12)});
  const auto b = set.add({.position = arm, .velocity = right.cross(arm), .angular_velocity = right, .mass = 2, .inertia = moments(0.1, 0.2, 0.15)});
  loop.add(BallJoint::Item{anchor(set, a, arm), anchor(set, b, -arm)});
  const Vec3 start = angular_momentum(set);
  for (int n = 0; n < 200; ++n) loop.step(1e-2);
  CHECK((angular_momentum(set) - start).norm() <= 1e-12 * start.norm());  // 200 steps of some hundred roundings
}

}  // namespace held_turns_tests
