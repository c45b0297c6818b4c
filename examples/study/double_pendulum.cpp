// Two point masses on two massless rods of a metre, released level: an independent solution in two angles is
// the reference.
#include "scene_study.hpp"

#include <delassus/delassus.hpp>
#include <delassus/schemes/error_controlled.hpp>
#include <delassus/solvers/direct_gauss_seidel.hpp>

#include <array>
#include <cmath>

namespace study_program {

namespace {

using State = std::array<double, 4>;  // two angles from the vertical, two rates

/// θ₁'' and θ₂'' of two equal masses on rods of length 1: the textbook's 2 × 2 system, solved.
State slope(const State& s) {
  const double g = 9.81, d = s[0] - s[1], c = std::cos(d), sine = std::sin(d);
  const double a = -s[3] * s[3] * sine - 2 * g * std::sin(s[0]), b = s[2] * s[2] * sine - g * std::sin(s[1]);
  const double det = 2 - c * c;
  return {s[2], s[3], (a - c * b) / det, (2 * b - c * a) / det};
}

State after(const State& s, const State& k, double h) {
  return {s[0] + h * k[0], s[1] + h * k[1], s[2] + h * k[2], s[3] + h * k[3]};
}

/// Where the lower mass is after t seconds, by the classical Runge-Kutta method at 0.1 ms: sure to 1e-11 m
/// for 3 s.
Vec3 tip(double t) {
  State s{EIGEN_PI / 2, EIGEN_PI / 2, 0, 0};
  const double h = 1e-4;
  for (long n = std::lround(t / h); n > 0; --n) {
    const State k1 = slope(s), k2 = slope(after(s, k1, h / 2)), k3 = slope(after(s, k2, h / 2)),
                k4 = slope(after(s, k3, h));
    for (std::size_t i = 0; i < 4; ++i) s[i] += h / 6 * (k1[i] + 2 * k2[i] + 2 * k3[i] + k4[i]);
  }
  return {std::sin(s[0]) + std::sin(s[1]), 0, -std::cos(s[0]) - std::cos(s[1])};
}

const auto scene = [](auto... policies) {
  AnimationLoop loop{World{Particles{}}, Constraints{DistanceJoint{}}, policies...};
  auto& points = bodies<Particles>(loop.world());
  const auto a = points.add({.position = {1, 0, 0}, .mass = 1.0}),
             b = points.add({.position = {2, 0, 0}, .mass = 1.0});
  loop.add(DistanceJoint::Item{.a = anchor(points, a), .b = world_anchor({0, 0, 0}), .length = 1});
  loop.add(DistanceJoint::Item{.a = anchor(points, b), .b = anchor(points, a), .length = 1});
  return loop;
};
const auto place = [](const auto& loop) { return loop.world().template set<0>().pose(1).position; };

}  // namespace

bool double_pendulum(const Options& options) {
  return run_study(options, "double_pendulum", 1e-3, scene,
                   Combinations{Choices{SymplecticEuler{}, ImplicitMidpoint{}},
                                Choices{Baumgarte{}, WholeViolation{}, PositionProjection{.rate = 1}},
                                Choices{AcceleratedGaussSeidel{}, GaussSeidel{}}},
                   {.name = "Double pendulum",
                    .duration = 3,
                    .steps = {0.02, 0.01, 0.005, 0.002, 0.001, 0.0005, 0.0002},
                    .tolerances = {1e-3, 1e-6, 1e-10},
                    .outputs = 30,
                    .repeats = 3},
                   Measures{Compared{"place of the tip", "m", place, tip}, energy_change(), joint_drift()});
}

bool double_pendulum_accuracy(const Options& options) {
  return run_study(options, "double_pendulum_accuracy", 1e-3, scene,
                   Combinations{Choices{PlainOrder{}, ErrorControlled{.length = 1}}, Choices{ImplicitMidpoint{}},
                                Choices{PositionProjection{.rate = 1}}, Choices{DirectGaussSeidel{}}},
                   {.name = "Double pendulum",
                    .duration = 3,
                    .steps = {0.02, 0.01, 0.005, 0.002, 0.001, 0.0005, 0.0002},
                    .accuracies = {1e-1, 1e-2, 1e-3, 1e-4, 1e-5, 1e-6},
                    .tolerances = {1e-12},
                    .outputs = 30,
                    .repeats = 3},
                   Measures{Compared{"place of the tip", "m", place, tip}, energy_change(), joint_drift()});
}

}  // namespace study_program
