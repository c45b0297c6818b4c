// Shafts in their bearings: their centres stand, and what a step may miss by is measured against their turn.
#include <delassus/bodies/anchor_at.hpp>
#include <delassus/bodies/rigid_bodies.hpp>
#include <delassus/constraints/joints/hinge.hpp>
#include <delassus/constraints/joints/point_on_line.hpp>
#include <delassus/constraints/joints/universal.hpp>
#include <delassus/loop/animation_loop.hpp>
#include <delassus/steppers/newton_midpoint.hpp>
#include <delassus/steppers/rattle.hpp>
#include <delassus/steppers/runge_kutta4.hpp>

#include "catch.hpp"

#include <cmath>

namespace shafts_tests {

using namespace delassus;

// A Cardan joint between shafts whose axes meet at β. With q the angle of the first,
//
//   ω_b = r ω_a,   r = cos β/(1 − sin² β cos² q),   ω_a² + ω_b² constant, the moments of both being 1.
TEMPLATE_TEST_CASE("a weightless Cardan shaft turns as its energy says", "", NewtonMidpoint, Rattle, RungeKutta4) {
  const double bend = 0.5, h = 1.0 / 60, whole = 1 + 1 / (std::cos(bend) * std::cos(bend));
  const auto rate = [&](double q) {
    const double r = std::cos(bend) / (1 - std::pow(std::sin(bend) * std::cos(q), 2));
    return std::sqrt(whole / (1 + r * r));
  };
  double right = 0;
  for (int n = 0; n < 1000; ++n) right += 1e-3 * rate(right + 0.5e-3 * rate(right));

  AnimationLoop loop{World{RigidBodies{}}, Constraints{Hinge{}, Universal{}, PointOnLine{}}, TestType{}};
  auto& set = bodies<RigidBodies>(loop.world());
  set.gravity = {0, 0, 0};
  const Quat turn = exponential<double>(Vec3(0, bend, 0));
  const Vec3 axis = turn * Vec3(0, 0, 1);
  const auto a = set.add({.position = {0, 0, -1}, .angular_velocity = {0, 0, 1}, .mass = 1, .inertia = Mat3::Identity()});
  const auto b = set.add({.position = axis, .orientation = turn, .angular_velocity = axis / std::cos(bend), .mass = 1, .inertia = Mat3::Identity()});
  loop.add(Hinge::Item{world_anchor({0, 0, -1}), anchor(set, a)});
  loop.add(Universal::Item{anchor_at(set, a, {0, 0, 0}), anchor_at(set, b, {0, 0, 0}, turn)});
  loop.add(PointOnLine::Item{world_anchor(axis, turn), anchor(set, b)});
  for (int n = 0; n < 60; ++n) REQUIRE(loop.step(h).status <= Status::stalled);
  const Quat q = set.orientation(a);
  CHECK(2 * std::atan2(q.z(), q.w()) == Approx(right).epsilon(2e-4));  // h² of the midpoint rule
}

// Two links let go level: A on a hinge at 0, its centre at s = 1/2, and B behind it on a universal joint that bends across their
// plane alone, its centre at r = 3/2; inertia J in all directions. In the plane they fall as one,
//
//   (2 J + m s² + M r²) α = (m s + M r) g,
//
// B by r α t while the angle is small. In its first step of 1e-6 s it goes 1e-11 m: rounding of places, 2e-16 m, is more than any tolerance of that.
TEMPLATE_TEST_CASE("bodies that hardly move in a step go as gravity says", "", NewtonMidpoint, Rattle, RungeKutta4) {
  const double J = 0.03, m = 1, M = 2, s = 0.5, r = 1.5, alpha = 9.81 * (m * s + M * r) / (2 * J + m * s * s + M * r * r);
  for (const double h : {1e-6, 1e-8}) {
    AnimationLoop loop{World{RigidBodies{}}, Constraints{Hinge{}, Universal{}}, TestType{}};
    auto& set = bodies<RigidBodies>(loop.world());
    const Mat3 inertia = Vec3(J, J, J).asDiagonal();
    const Quat across = frame_along({0, 1, 0}), askew = exponential<double>(Vec3(0.1, 0.3, 0.05));
    const auto a = set.add({.position = {s, 0, 0}, .mass = m, .inertia = inertia});
    const auto b = set.add({.position = {r, 0, 0}, .orientation = askew, .mass = M, .inertia = inertia});
    loop.add(Hinge::Item{world_anchor({0, 0, 0}, across), anchor_at(set, a, {0, 0, 0}, across)});
    loop.add(Universal::Item{anchor_at(set, a, {1, 0, 0}, across), anchor_at(set, b, {1, 0, 0}, across)});
    for (int n = 0; n < 1000; ++n) REQUIRE(loop.step(h).status <= Status::stalled);
    CHECK(-set.velocity(b).z() == Approx(r * alpha * 1000 * h).epsilon(1e-3));
  }
}

}  // namespace shafts_tests
