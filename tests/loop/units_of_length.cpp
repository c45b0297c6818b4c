#include "scenes.hpp"

#include <delassus/constraints/contact/rolling_coulomb.hpp>
#include <delassus/constraints/joints/drive.hpp>
#include <delassus/constraints/joints/hinge.hpp>
#include <delassus/constraints/joints/limit.hpp>
#include <delassus/constraints/joints/motor.hpp>
#include <delassus/constraints/joints/slider.hpp>
#include <delassus/constraints/joints/weld.hpp>
#include <delassus/schemes/joint_by_joint.hpp>
#include <delassus/solvers/direct_gauss_seidel.hpp>
#include <delassus/solvers/minimum_norm.hpp>
#include <delassus/solvers/path_newton.hpp>
#include <delassus/solvers/proximal_newton.hpp>

#include "catch.hpp"

#include <cmath>

namespace units_of_length_tests {

using namespace scenes;

namespace {

/// What a run is, in metres whatever it was written in.
struct Told {
  long sweeps = 0;
  std::vector<double> state, residuals;
  bool operator==(const Told&) const = default;
};

Told told(auto& loop, int steps, double unit) {
  Told out;
  for (int n = 0; n < steps; ++n) {
    const StepReport r = loop.step(1.0 / 120);
    out.sweeps += r.sweeps;
    out.residuals.push_back(r.residual);
  }
  auto& set = rigid_bodies(loop);
  for (const Index b : alive(set)) {
    const auto handle = set.handle(b);
    const Vec3 x = set.position(handle) / unit, v = set.velocity(handle) / unit, w = set.angular_velocity(handle);
    for (int k = 0; k < 3; ++k) out.state.insert(out.state.end(), {x[k], v[k], w[k]});
  }
  return out;
}

RigidBody block(const Vec3& at, const Vec3& size, double mass, double unit) {
  const Quat turned = exponential<double>(Vec3(0.1, -0.2, 0.15));
  return {.position = at * unit, .orientation = turned, .mass = mass, .shape = Box{size[0] * unit, size[1] * unit, size[2] * unit}};
}

/// Blocks that hang on a place of the world and on each other by hinges, a weld and a slider, one of them twenty times as heavy.
/// A motor, a stop and a spring act on the hinges. `unit`: how many units of length make a metre.
template <class Solver, class Scheme = PlainOrder>
Told mechanism(double unit, const Solver& solver, int steps, const Scheme& scheme = {}) {
  constexpr bool is_whole = !std::is_same_v<Scheme, JointByJoint>;
  auto laws = [] {
    if constexpr (is_whole) return Constraints{Hinge{}, Weld{}, Slider{}, Motor<Turn>{}, Limit<Turn>{}, Drive<Turn>{}};
    else return Constraints{Hinge{}, Weld{}, Slider{}};
  };
  auto loop = [&] {
    if constexpr (is_whole) return AnimationLoop{World{RigidBodies{}}, laws(), solver};
    else return AnimationLoop{World{RigidBodies{}}, laws(), scheme};
  }();
  auto& set = rigid_bodies(loop);
  set.gravity = Vec3(0, 0, -9.81 * unit);
  RigidBodies::Handle last{};
  for (int i = 0; i < 4; ++i) {
    const Vec3 at = Vec3(0.3 * i, 0.02 * i, 0) * unit;
    const Quat axis = frame_along({0.1, 1, 0.2 * i});
    const auto next = set.add(block({0.3 * i + 0.15, 0.02 * i, 0}, {0.3, 0.05, 0.04}, i == 2 ? 20.0 : 1.0, unit));
    const Anchor a = i == 0 ? world_anchor(at, axis) : anchor_at(set, last, at, axis), b = anchor_at(set, next, at, axis);
    loop.add(Hinge::Item{a, b});
    if constexpr (is_whole) {
      const double moment = unit * unit;  // of 1 N·m
      if (i == 1) loop.add(Motor<Turn>::Item{.a = a, .b = b, .speed = 1, .max_force = 2 * moment});
      if (i == 2) loop.add(Limit<Turn>::Item{.a = a, .b = b, .lower = -0.02, .upper = 0.1});
      if (i == 3) loop.add(Drive<Turn>::Item{.a = a, .b = b, .target = 0.2, .stiffness = 5 * moment, .damping = 0.1 * moment});
    }
    last = next;
  }
  const auto tool = set.add(block({1.4, 0.1, 0.2}, {0.1, 0.2, 0.1}, 0.5, unit)), carriage = set.add(block({1.5, 0.1, 0}, {0.1, 0.1, 0.1}, 0.3, unit));
  const Vec3 at = Vec3(1.3, 0.1, 0.1) * unit;
  loop.add(Weld::Item{anchor_at(set, last, at), anchor_at(set, tool, at)});
  loop.add(Slider::Item{anchor_at(set, tool, at), anchor_at(set, carriage, at)});
  return told(loop, steps, unit);
}

/// Balls that roll and spin, and a box among them.
template <class Solver>
Told rolling(double unit, const Solver& solver, int steps) {
  AnimationLoop loop{World{RigidBodies{}},
                     Constraints{Contact{RollingCoulomb{.friction = 0.6, .rolling_friction = 0.02 * unit, .torsional_friction = 0.01 * unit}}},
                     Baumgarte{.max_speed = unit}, solver};
  auto& set = rigid_bodies(loop);
  set.gravity = Vec3(0, 0, -9.81 * unit);
  set.add_fixed(HalfSpace{});
  for (int i = 0; i < 4; ++i) {
    const auto ball = set.add({.position = Vec3(0.21 * i, 0.01 * i, 0.1 + 0.001 * i) * unit, .mass = 1.0 + i, .shape = Sphere{0.1 * unit}});
    set.set_velocity(ball, Vec3(1 - 0.4 * i, 0.2, 0) * unit, {0, 3, 1});
  }
  set.add(block({0.3, 0, 0.27}, {0.3, 0.2, 0.1}, 3, unit));
  return told(loop, steps, unit);
}

/// Powers of two, so that no number is rounded otherwise.
constexpr double units[] = {1024, 1.0 / 1024};

}  // namespace

TEST_CASE("hinges, welds and sliders in another unit of length end after as many sweeps, in the same state to the bit") {
  const auto same = [](const auto& solver, int steps) {
    const Told in_metres = mechanism(1, solver, steps);
    for (const double unit : units) {
      CAPTURE(unit);
      CHECK(mechanism(unit, solver, steps) == in_metres);
    }
  };
  same(AcceleratedGaussSeidel{}, 20);
  same(GaussSeidel{}, 3);
  same(ProximalNewton{}, 5);
  same(MinimumNorm{AcceleratedGaussSeidel{}}, 5);
  same(PathNewton{}, 3);
}

// Its pivots inside a block are chosen by size, in which units take part: the states differ by rounding.
TEST_CASE("by the direct solver a mechanism in another unit of length is the same to rounding") {
  const Told in_metres = mechanism(1, DirectGaussSeidel{}, 20);
  for (const double unit : units) {
    const Told there = mechanism(unit, DirectGaussSeidel{}, 20);
    CHECK(there.sweeps == in_metres.sweeps);
    for (std::size_t k = 0; k < in_metres.state.size(); ++k) CHECK(std::abs(there.state[k] - in_metres.state[k]) <= 1e-10);
  }
}

TEST_CASE("joint by joint a mechanism in another unit of length has the same residuals") {
  const Told in_metres = mechanism(1, 0, 20, JointByJoint{});
  for (const double unit : units) CHECK(mechanism(unit, 0, 20, JointByJoint{}) == in_metres);
}

TEST_CASE("contacts that brake rolling in another unit of length end after as many sweeps, in the same state to the bit") {
  const auto same = [](const auto& solver, int steps) {
    const Told in_metres = rolling(1, solver, steps);
    for (const double unit : units) {
      CAPTURE(unit);
      CHECK(rolling(unit, solver, steps) == in_metres);
    }
  };
  same(AcceleratedGaussSeidel{}, 10);
  same(ProximalNewton{}, 5);
}

// A hinge's error is that of its rows at the length of the island: turns of a body as long as 1 m count as much as motions.
// In metres, millimetres and kilometres one tolerance then stands for one error of angle.
TEST_CASE("an angle that a solve leaves is the same in every unit of length") {
  const auto left = [](double unit) {
    AnimationLoop loop{World{RigidBodies{}}, Constraints{Hinge{}}, GaussSeidel{.tolerance = 1e-3}};
    auto& set = rigid_bodies(loop);
    set.gravity = Vec3(0, 0, -9.81 * unit);
    const auto a = set.add(block({0, 0, 0}, {1, 0.2, 0.2}, 1, unit)), b = set.add(block({1, 0, 0}, {1, 0.2, 0.2}, 1, unit)),
               c = set.add(block({2, 0, 0}, {1, 0.2, 0.2}, 1, unit));
    const Quat axis = frame_along({0, 1, 0});
    loop.add(Hinge::Item{world_anchor(Vec3(-0.5, 0, 0) * unit, axis), anchor_at(set, a, Vec3(-0.5, 0, 0) * unit, axis)});
    loop.add(Hinge::Item{anchor_at(set, a, Vec3(0.5, 0, 0) * unit, axis), anchor_at(set, b, Vec3(0.5, 0, 0) * unit, axis)});
    loop.add(Hinge::Item{anchor_at(set, b, Vec3(1.5, 0, 0) * unit, axis), anchor_at(set, c, Vec3(1.5, 0, 0) * unit, axis)});
    set.set_velocity(c, Vec3(0, 0, 0), Vec3(3, 0, 2));
    REQUIRE(loop.step(0.01).status == Status::converged);
    const Vec3 w = set.angular_velocity(c) - set.angular_velocity(b);
    return Vec3(w - w.dot(Vec3(0, 1, 0)) * Vec3(0, 1, 0)).norm();
  };
  const double in_metres = left(1);
  for (const double unit : {1e-3, 1e3}) CHECK(left(unit) == Approx(in_metres).epsilon(1e-6));
}

}  // namespace units_of_length_tests
