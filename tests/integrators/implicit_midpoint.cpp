#include <delassus/integrators/implicit_midpoint.hpp>

#include <array>
#include <cmath>

#include "catch.hpp"
#include "convergence_order.hpp"
#include "integrators/free_fall.hpp"
#include "integrators/oscillator.hpp"

using namespace delassus;

// The parabola is met at the steps; 60 steps round v and x a few times each, 60 · 4 · 2^-53 < 1e-13.
TEST_CASE("a body falls on the exact parabola with the midpoint rule") {
  const double h = 1.0 / 60;
  REQUIRE(free_fall::worst_error(ImplicitMidpoint{}, 60,
                                 [&](int n) { return -free_fall::g * h * h * n * n / 2; }) <= 1e-13);
}

// A step is the Cayley map of (x, v/ω): x_n = cos(n θ), tan(θ/2) = h ω/2; θ/(h ω) is the reference's ratio.
TEST_CASE("the midpoint rule oscillates too slowly by the factor of its closed form, at full amplitude") {
  const double h = 0.01, turn = 0.9996712078675766 * oscillator::omega * h;
  auto [loop, mass] = oscillator::make(ImplicitMidpoint{}, oscillator::omega);
  auto& set = bodies<Particles>(loop.world());
  for (int n = 1; n <= 1000; ++n) {
    loop.step(h);
    REQUIRE(std::abs(set.position(mass).x() - std::cos(n * turn)) <= 1e-12);
  }
}

// Cayley's map is orthogonal; 1000 steps of some ten roundings, without bias: √1000 · 10 · 2^-53 ~ 4e-14.
TEST_CASE("the midpoint rule keeps the energy of an oscillator to rounding") {
  auto [loop, mass] = oscillator::make(ImplicitMidpoint{}, oscillator::omega);
  auto& set = bodies<Particles>(loop.world());
  const double start = kinetic_energy(set) + potential_energy(set);
  for (int n = 1; n <= 1000; ++n) {
    loop.step(0.01);
    REQUIRE(kinetic_energy(set) + potential_energy(set) == Approx(start).epsilon(1e-13));
  }
}

// |x| <= 1 exactly. A = m + k h²/4 is rounded at 2.5e11: x and v/ω are off by 2^-53 a step, times the factor
// 4 by which x returns through v.
TEST_CASE("the midpoint rule is bounded at h w = 1e6") {
  auto [loop, mass] = oscillator::make(ImplicitMidpoint{}, 1e6);
  auto& set = bodies<Particles>(loop.world());
  for (int n = 0; n < 10000; ++n) {
    loop.step(1.0);
    REQUIRE(std::abs(set.position(mass).x()) <= 1 + 1e-9);
  }
}

namespace {

/// A pendulum whose pivot is shaken by a kinematic body, after one second.
Vec3 shaken(int steps) {
  AnimationLoop loop{World{RigidBodies{}, Particles{}}, Constraints{DistanceJoint{}}, ImplicitMidpoint{},
                     WholeViolation{}};
  auto& rigid = bodies<RigidBodies>(loop.world());
  auto& points = bodies<Particles>(loop.world());
  const double h = 1.0 / steps;
  const auto pivot = rigid.add({.motion = Motion::kinematic});
  // It starts with the velocity of the pivot: no jump that would hide the order.
  const auto bob = points.add({.position = {1, 0, 0}, .velocity = {0.6, 0, 0}, .mass = 1.0});
  loop.add(DistanceJoint::Item{anchor(rigid, pivot), anchor(points, bob), 1.0});
  for (int n = 1; n <= steps; ++n) {
    rigid.move_to(pivot, {0.2 * std::sin(3 * h * n), 0, 0});
    loop.step(h);
  }
  return points.position(bob);
}

}  // namespace

TEST_CASE("the midpoint rule keeps its order when a kinematic body moves the pivot") {
  const Vec3 fine = shaken(1 << 15);
  std::array<double, 3> errors{};
  for (int k = 0; k < 3; ++k) errors[k] = (shaken(200 << k) - fine).norm();
  for (int k = 0; k < 2; ++k) {
    const double order = convergence_order(errors[k], errors[k + 1]);
    CHECK((order >= 1.85 && order <= 2.5));
  }
}

// Momentum about the pivot, which is led at V from the start on: ω = m L V/(I + m L²), and so for ever. The velocity of a step is
// that of its mean: what is across the joint after the first one fades, by a tenth a step.
TEST_CASE("a rod on a kinematic hinge that is set going turns as its momentum says") {
  const double length = 0.5, mass = 2, inertia = 0.1, speed = 1, right = mass * length * speed / (inertia + mass * length * length);
  double error[2];
  for (const int k : {0, 1}) {
    const double h = k ? 1.0 / 240 : 1.0 / 60;
    AnimationLoop loop{World{RigidBodies{}}, Constraints{Hinge{}}, ImplicitMidpoint{}, PositionProjection{.rate = 1}};
    auto& set = bodies<RigidBodies>(loop.world());
    set.gravity = {0, 0, 0};
    const Quat across = frame_along({0, 1, 0});
    const auto pivot = set.add({.motion = Motion::kinematic});
    const auto rod = set.add({.position = {0, 0, -length}, .mass = mass, .inertia = inertia * Mat3::Identity()});
    loop.add(Hinge::Item{anchor_at(set, pivot, {0, 0, 0}, across), anchor_at(set, rod, {0, 0, 0}, across)});
    set.set_velocity(pivot, {speed, 0, 0});
    double turned = 0;
    for (int n = 0; n < std::lround(1 / h); ++n) {
      const double before = set.angular_velocity(rod).y();
      loop.step(h);
      turned += 0.5 * h * (before + set.angular_velocity(rod).y());
    }
    error[k] = std::abs(turned - right);
    CHECK(set.angular_velocity(rod).y() == Approx(right).epsilon(0.03));
  }
  CHECK(error[0] < 0.03);
  CHECK(error[1] < error[0] / 3);
}

TEST_CASE("a bead on a wire slides down it under the midpoint rule") {
  AnimationLoop loop{World{RigidBodies{}}, Constraints{PointOnLine{}}, ImplicitMidpoint{}, PositionProjection{.rate = 1}};
  auto& set = bodies<RigidBodies>(loop.world());
  const Vec3 wire = Vec3(1, 0, -1).normalized();
  const auto bead = set.add({.mass = 1, .inertia = Mat3::Identity()});
  loop.add(PointOnLine::Item{world_anchor({0, 0, 0}, frame_along(wire)), anchor(set, bead)});
  for (int n = 0; n < 60; ++n) loop.step(1.0 / 60);
  const double way = 0.5 * 9.81 * std::sqrt(0.5);
  CHECK((set.position(bead) - way * wire).norm() <= 1e-9);
}
