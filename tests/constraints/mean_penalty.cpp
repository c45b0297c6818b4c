// Penalty contacts whose springs see the mean velocity of a step: the midpoint rule's.
#include "convergence_order.hpp"
#include "scenes.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "catch.hpp"

namespace mean_penalty_tests {

using namespace scenes;

namespace {

constexpr double k = 2e3, friction = 0.3;

template <class When>
auto loop_with(double damping, When when) {
  return AnimationLoop{World{RigidBodies{}},
                       Constraints{Contact{Penalty{Coulomb{.friction = friction}, k, damping, when}}},
                       ImplicitMidpoint{}, AcceleratedGaussSeidel{.tolerance = 1e-12}};
}

/// A ball of 1 kg and radius 0.5 m with its centre at `height` above the ground, that slides along x at
/// 20 m/s.
template <class Loop>
RigidBodies::Handle add_ball(Loop& loop, double height) {
  auto& set = rigid_bodies(loop);
  set.add_fixed(HalfSpace{});
  return set.add({.position = {0, 0, height}, .velocity = {20, 0, 0}, .mass = 1.0, .shape = Sphere{0.5}});
}

/// Where the ball is after t, if it has z, and has not begun to roll: m v_x' = −μ f_n, f_n = m (g + z'').
Vec3 slid(double z, double start_z, double t) {
  return {20 * t - friction * (z - start_z + 0.5 * g * t * t), 0, z};
}

/// Dropped from `drop` above the floor: falls and half swings of the spring in turn, without loss.
double bounced(double drop, double t) {
  const double omega = std::sqrt(k), fall = std::sqrt(2 * drop / g), v = g * fall;
  const double touch = 2 / omega * (std::numbers::pi - std::atan(v * omega / g));
  t = std::fmod(t, 2 * fall + touch);
  if (t > fall + touch) t = 2 * fall + touch - t;
  if (t < fall) return 0.5 + drop - 0.5 * g * t * t;
  const double phase = omega * (t - fall);
  return 0.5 - g / k * (1 - std::cos(phase)) - v / omega * std::sin(phase);
}

/// Root of the mean square of 32 drops' errors after 0.4 s: where within its step a drop meets the floor, and
/// leaves it, is by chance.
template <class When>
double error_of_bounces(double h, When when) {
  double sum = 0;
  for (int i = 0; i < 32; ++i) {
    const double drop = 0.05 + 0.001 * i;
    auto loop = loop_with(0, when);
    const auto ball = add_ball(loop, 0.5 + drop);
    const long steps = std::lround(0.4 / h);
    for (long n = 0; n < steps; ++n) loop.step(h);
    const double z = bounced(drop, 0.4);
    sum += (rigid_bodies(loop).position(ball) - slid(z, 0.5 + drop, 0.4)).squaredNorm();
  }
  return std::sqrt(sum / 32);
}

/// A ball that stays on the floor, and swings about where it rests with an amplitude of half its sag.
template <class When>
double error_of_swing(double h, double damping, When when) {
  auto loop = loop_with(damping, when);
  const double sag = g / k;
  const auto ball = add_ball(loop, 0.5 - 0.5 * sag);
  const long steps = std::lround(0.4 / h);
  for (long n = 0; n < steps; ++n) loop.step(h);
  const double fade = 0.5 * damping, omega = std::sqrt(k - fade * fade);
  const double z =
      0.5 - sag +
      0.5 * sag * std::exp(-fade * 0.4) * (std::cos(omega * 0.4) + fade / omega * std::sin(omega * 0.4));
  return (rigid_bodies(loop).position(ball) - slid(z, 0.5 - 0.5 * sag, 0.4)).norm();
}

/// Where a ball is after 0.2 s that is thrown across a slope, swings on its spring, and does not come to
/// roll.
Vec3 thrown_across(double h) {
  auto loop = loop_with(0, AtMean{});
  auto& set = rigid_bodies(loop);
  set.gravity = {4, 0, -g};
  const auto ball = add_ball(loop, 0.5 - 0.5 * g / k);
  set.set_velocity(ball, {0, 2, 0});
  for (long n = std::lround(0.2 / h); n > 0; --n) loop.step(h);
  return set.position(ball);
}

}  // namespace

TEST_CASE(
    "a ball that slides and bounces on springs is met with second order by their mean, with first else") {
  const auto mean = convergence_orders([](double h) { return error_of_bounces(h, AtMean{}); }, 4e-3);
  const auto end = convergence_orders([](double h) { return error_of_bounces(h, AtEnd{}); }, 1e-3);
  CAPTURE(mean[0], mean[1], end[0], end[1]);
  CHECK(are_of_order(mean, 2));
  CHECK(are_of_order(end, 1));
}

TEST_CASE("a ball that slides and swings on a damped spring is met with second order by its mean") {
  for (const double damping : {0.0, 20.0}) {
    const auto orders =
        convergence_orders([&](double h) { return error_of_swing(h, damping, AtMean{}); }, 4e-3);
    CAPTURE(damping, orders[0], orders[1]);
    CHECK(are_of_order(orders, 2));
  }
}

TEST_CASE("a ball whose slip turns as it swings on a spring is met with second order by the spring's mean") {
  const Vec3 there = thrown_across(0.01 / 512);  // its own error is some 1/4000 of the finest below
  const auto orders = convergence_orders([&](double h) { return (thrown_across(h) - there).norm(); }, 0.01);
  CAPTURE(orders[0], orders[1]);
  CHECK(are_of_order(orders, 2));
}

// Within the springs the rule is exact in energy; where one begins or ends within a step its energy is off by
// ½ k δ² of the side that is left out, δ ≤ h v/2, twice a bounce.
TEST_CASE(
    "a ball bounces on a spring of the mean for 1000 times, and keeps its energy to the square of the step") {
  const double h = 1e-3, drop = 0.05, v = std::sqrt(2 * g * drop), period = 0.28;
  auto loop = loop_with(0, AtMean{});
  const auto ball = add_ball(loop, 0.5 + drop);
  auto& set = rigid_bodies(loop);
  set.set_velocity(ball, {0, 0, 0});
  double worst = 0, touches = 0;
  bool is_in_air = true;
  for (long n = 0; n < std::lround(1000 * period / h); ++n) {
    loop.step(h);
    const double u = set.velocity(ball).z(), height = set.position(ball).z() - 0.5;
    const double depth = std::max(0.0, -height);
    worst = std::max(worst, std::abs(0.5 * u * u + g * height + 0.5 * k * depth * depth - g * drop));
    if (is_in_air && depth > 0) ++touches;
    is_in_air = depth == 0;
  }
  CAPTURE(touches, worst);
  CHECK(touches >= 900);
  // The rule is the same forwards and backwards: what one bounce gives another takes, and none of it adds up.
  CHECK(worst <= 2 * 0.5 * k * 0.25 * h * h * v * v);
}

TEST_CASE("a ball at rest on a damped spring of the mean sags by its weight over the stiffness") {
  auto loop = loop_with(2 * std::sqrt(k), AtMean{});
  const auto ball = add_ball(loop, 0.5);
  rigid_bodies(loop).set_velocity(ball, {0, 0, 0});
  for (int n = 0; n < 1200; ++n) loop.step(1.0 / 60);
  CHECK(0.5 - rigid_bodies(loop).position(ball).z() == Approx(g / k).epsilon(1e-9));
  CHECK(rigid_bodies(loop).velocity(ball).norm() <= 1e-12);
}

}  // namespace mean_penalty_tests
