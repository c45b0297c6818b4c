// Physical errors of a study against closed forms: the orders that the integrators promise.
#include "catch.hpp"
#include "convergence_order.hpp"

#include <delassus/delassus.hpp>
#include <delassus/study/sweep.hpp>

#include <cmath>

namespace convergence_pendulum_tests {

using namespace delassus;

namespace {

constexpr double g = 9.81;

}  // namespace

TEST_CASE(
    "a pendulum's error falls by 2 with symplectic Euler and by 4 with the midpoint rule when h is halved") {
  const auto scene = [](auto... policies) {
    AnimationLoop loop{World{Particles{}}, Constraints{DistanceJoint{}}, PositionProjection{.rate = 1},
                       policies...};
    auto& points = bodies<Particles>(loop.world());
    const auto bob = points.add({.position = {1, 0, 0}, .mass = 1.0});
    loop.add(DistanceJoint::Item{.a = anchor(points, bob), .b = world_anchor({0, 0, 0}), .length = 1});
    return loop;
  };
  const auto place = [](const auto& loop) { return loop.world().template set<0>().pose(0).position; };
  // θ'' = −g sin θ from θ = π/2 at rest, by the classical Runge-Kutta method at 1e-4: its own error is below
  // 1e-14.
  const auto exact = [](double t) {
    double angle = EIGEN_PI / 2, rate = 0;
    const long n = std::lround(t / 1e-4);
    for (long k = 0; k < n; ++k) {
      const double s = 1e-4;
      const auto slope = [](double a) { return -g * std::sin(a); };
      const double a1 = rate, b1 = slope(angle), a2 = rate + 0.5 * s * b1, b2 = slope(angle + 0.5 * s * a1);
      const double a3 = rate + 0.5 * s * b2, b3 = slope(angle + 0.5 * s * a2), a4 = rate + s * b3,
                   b4 = slope(angle + s * a3);
      angle += s / 6 * (a1 + 2 * a2 + 2 * a3 + a4);
      rate += s / 6 * (b1 + 2 * b2 + 2 * b3 + b4);
    }
    return Vec3(std::sin(angle), 0, -std::cos(angle));
  };
  // A quarter of the period of [A01] is 0.591960485 s: there the bob hangs straight down.
  CHECK(exact(0.592).z() == Approx(-1).margin(1e-6));
  const StudyPlan plan{.name = "pendulum",
                       .duration = 1,
                       .steps = {1. / 200, 1. / 400, 1. / 800},
                       .tolerances = {1e-12},
                       .outputs = 10,
                       .repeats = 1,
                       .is_quiet = true};
  const Study study = sweep(
      scene, Combinations{Choices{SymplecticEuler{}, ImplicitMidpoint{}}, Choices{AcceleratedGaussSeidel{}}},
      plan, Measures{Compared{"place", "m", place, exact}, energy_change()});
  // Orders within the band of a measured slope: one tenth below, where the next term of the expansion is
  // still seen.
  CHECK(convergence_order(study, 1) == Approx(1).margin(0.1));
  CHECK(convergence_order(study, 4) == Approx(2).margin(0.1));
  // Of the midpoint rule with gaps closed by projection the energy is off in second order too.
  CHECK(convergence_order(study, 4, 1) == Approx(2).margin(0.1));
}

}  // namespace convergence_pendulum_tests
