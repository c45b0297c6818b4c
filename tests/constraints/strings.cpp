#include <delassus/delassus.hpp>
#include <delassus/schemes/error_controlled.hpp>
#include <delassus/steppers/newton_midpoint.hpp>

#include "catch.hpp"

#include <cmath>
#include <vector>

namespace strings_tests {

using namespace delassus;

namespace {

constexpr double g = 9.81;

/// A ball of 2 kg on a string of a metre from the origin, by what is left of the arguments.
auto ball_on_a_string(const Vec3& position, const Vec3& velocity, double restitution, auto... policies) {
  AnimationLoop loop{World{RigidBodies{}}, Constraints{Limit<Length>{}}, policies...};
  auto& set = bodies<RigidBodies>(loop.world());
  const auto ball = set.add({.position = position, .velocity = velocity, .mass = 2.0, .shape = Sphere{0.05}});
  loop.add(Limit<Length>::Item{.a = world_anchor({0, 0, 0}), .b = anchor(set, ball), .upper = 1, .restitution = restitution});
  return loop;
}

}  // namespace

TEST_CASE("a slack string does nothing, to the bit") {
  auto tied = ball_on_a_string({0.1, 0, 0}, {0.5, 0.2, 1}, 0);
  AnimationLoop free{World{RigidBodies{}}, Constraints{Limit<Length>{}}};
  auto& set = bodies<RigidBodies>(free.world());
  set.add({.position = {0.1, 0, 0}, .velocity = {0.5, 0.2, 1}, .mass = 2.0, .shape = Sphere{0.05}});
  for (int n = 0; n < 40; ++n) tied.step(1e-2), free.step(1e-2);
  CHECK(bodies<RigidBodies>(tied.world()).pose(0).position == set.pose(0).position);
  CHECK(set.pose(0).position.norm() < 1);
}

// Without gravity: from (0, 0.6, 0) along x at 1 m/s it is taut at x = 0.8, t = 0.8. Then the string takes the speed along it,
// 0.8 of 1 m/s, and leaves 0.6 across it; or turns it back to −0.8 e. On the circle it keeps 0.6 m/s and the string pulls with
// m v²/l = 0.72 N.
TEST_CASE("a string that snaps taut takes the speed along it and leaves the one across it") {
  for (const double e : {0.0, 0.5, 1.0}) {
    auto loop = ball_on_a_string({0, 0.6, 0}, {1, 0, 0}, e);
    auto& set = bodies<RigidBodies>(loop.world());
    set.gravity.setZero();
    const double h = 1e-3;
    while (loop.time() < 0.81) loop.step(h);
    const Vec3 out(0.8, 0.6, 0), across(0.6, -0.8, 0);
    const Vec3 v = set.velocity()[0].head<3>();
    CAPTURE(e, v.transpose());
    CHECK(std::abs(v.dot(across) - 0.6) < 0.01);  // 10 ms on it has turned by 0.6 %
    CHECK(std::abs(v.dot(out) + 0.8 * e) < 0.01);
    if (e > 0) continue;
    while (loop.time() < 3) loop.step(h);
    CHECK(std::abs(set.velocity()[0].head<3>().norm() - 0.6) < 2e-3);
    CHECK(std::abs(set.pose(0).position.norm() - 1) < 1e-6);
    double pull = 0;
    loop.data().each_impulse([&](const auto& impulse) { pull += impulse[1]; });
    CHECK(std::abs(pull / h + 0.72) < 0.01);
  }
}

// Thrown with v² = 3 g l from the lowest point, the bob leaves its circle where v² = −g l cos θ: at cos θ = −1/3, with
// v = √(g l/3) along the circle. Until then it is a pendulum, from then on it flies.
TEST_CASE("a string goes slack where a pendulum would have to be pushed") {
  const double end = 0.9;
  double theta = 0, rate = std::sqrt(3 * g), t = 0;
  const double dt = 1e-5;
  const auto turn = [](double angle) { return -g * std::sin(angle); };
  while (rate * rate + g * std::cos(theta) > 0) {  // the midpoint rule: 1e-10 of an angle
    const double half = theta + 0.5 * dt * rate, half_rate = rate + 0.5 * dt * turn(theta);
    theta += dt * half_rate, rate += dt * turn(half), t += dt;
  }
  REQUIRE(std::abs(std::cos(theta) + 1. / 3) < 1e-4);
  const double left = end - t;
  REQUIRE(left > 0.1);
  const Vec3 truth(std::sin(theta) + rate * std::cos(theta) * left, 0, -std::cos(theta) + rate * std::sin(theta) * left - 0.5 * g * left * left);
  REQUIRE(truth.norm() < 0.99);

  const auto error = [&](double h) {
    AnimationLoop loop{World{Particles{}}, Constraints{Limit<Length>{}}, ImplicitMidpoint{}, PositionProjection{.rate = 1}};
    auto& set = bodies<Particles>(loop.world());
    const auto bob = set.add({.position = {0, 0, -1}, .velocity = {std::sqrt(3 * g), 0, 0}, .mass = 1.0});
    loop.add(Limit<Length>::Item{.a = world_anchor({0, 0, 0}), .b = anchor(set, bob), .upper = 1});
    for (long n = std::lround(end / h); n > 0; --n) loop.step(h);
    return (set.pose(0).position - truth).norm();
  };
  const double coarse = error(1e-3), fine = error(5e-4);
  CAPTURE(coarse, fine);
  CHECK(coarse < 2e-2);  // of first order: eight steps at the speed of leaving
  CHECK(fine < coarse / 1.6);
}

TEST_CASE("a chain of strings that is dropped snaps taut: the search for it ends, and no string is longer than it is") {
  AnimationLoop loop{World{RigidBodies{}}, Constraints{Limit<Length>{}}, ImplicitMidpoint{}, PositionProjection{},
                     AcceleratedGaussSeidel{.tolerance = 1e-10}, ErrorControlled{.accuracy = 1e-3, .length = 0.1, .max_step = 0.02}};
  auto& set = bodies<RigidBodies>(loop.world());
  // Ten balls hang on strings of 10 cm, drawn together to 4 cm, the last one heavy: they fall, and each string snaps once or more.
  Anchor last = world_anchor({0, 0, 0});
  for (int k = 1; k <= 10; ++k) {
    const auto ball = set.add({.position = {0.01 * (k % 3), 0, -0.04 * k}, .mass = k == 10 ? 2.0 : 0.2, .shape = Sphere{0.01}});
    loop.add(Limit<Length>::Item{.a = last, .b = anchor(set, ball), .upper = 0.1});
    last = anchor(set, ball);
  }
  long floor = 0, steps = 0, impacts = 0;
  double longest = 0, energy = 1e300;
  for (int n = 0; n < 20; ++n) {
    loop.step(0.02);
    floor += error_report(loop).at_floor;
    steps += error_report(loop).steps;
    impacts += error_report(loop).by_effect[std::size_t(ErrorEffect::impact)].steps;
    Vec3 before = Vec3::Zero();
    for (Index b = 0; b < 10; ++b) longest = std::max(longest, (set.pose(b).position - before).norm()), before = set.pose(b).position;
    const double now = kinetic_energy(set) + potential_energy(set);
    CHECK(now < energy + 1e-3);
    energy = now;
  }
  CAPTURE(steps, impacts);
  CHECK(impacts >= 10);
  CHECK(floor <= 10);
  CHECK(longest < 0.1 + 1e-4);
}

}  // namespace strings_tests
