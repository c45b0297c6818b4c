#include <delassus/constraints/joints/rotor_inertia.hpp>
#include <delassus/constraints/joints/spring_damper.hpp>
#include <delassus/delassus.hpp>
#include <delassus/solvers/direct_gauss_seidel.hpp>
#include <delassus/steppers/newton_midpoint.hpp>

#include "catch.hpp"

#include <cmath>
#include <utility>

namespace rotor_inertia_tests {

using namespace delassus;

namespace {

constexpr double stiffness = 40, damping = 1, first = 0.3, second = 0.7, rotor = 0.4;  // N·m/rad, N·m·s/rad, kg·m²

/// Two wheels on one axis, free in space, a spring and a damper between them and a rotor; from a turn of a radian. The turn and the
/// angular momentum after `end` s.
template <class Integrator>
std::pair<double, double> wheels(double end, double h) {
  AnimationLoop loop{World{RigidBodies{}}, Constraints{Hinge{}, SpringDamper<Turn>{}, RotorInertia<Turn>{}}, Integrator{}, DirectGaussSeidel{.tolerance = 1e-12}};
  auto& set = bodies<RigidBodies>(loop.world());
  set.gravity.setZero();
  const auto one = set.add({.mass = 1.0, .inertia = Mat3(first * Mat3::Identity())}), other = set.add({.mass = 1.0, .inertia = Mat3(second * Mat3::Identity())});
  const Anchor a = anchor(set, one), b = anchor(set, other);
  loop.add(Hinge::Item{a, b});
  loop.add(SpringDamper<Turn>::Item{.a = a, .b = b, .rest = -1, .stiffness = stiffness, .damping = damping});
  loop.add(RotorInertia<Turn>::Item{.a = a, .b = b, .inertia = rotor});
  for (long n = std::lround(end / h); n > 0; --n) loop.step(h);
  const double spin = first * set.velocity()[0][5] + second * set.velocity()[1][5];
  return {Turn::value({a, b, loop.world()}) + 1, spin};
}

/// q of M q̈ + c q̇ + k q = 0 from 1 at rest, 1/M₀ = 1/I₁ + 1/I₂ and M = M₀ + I_rotor.
double closed_form(double t) {
  const double M = first * second / (first + second) + rotor, decay = damping / (2 * M), w = std::sqrt(stiffness / M - decay * decay);
  return std::exp(-decay * t) * (std::cos(w * t) + decay / w * std::sin(w * t));
}

}  // namespace

TEST_CASE("a rotor adds to the inertia of the relative turn, at order two under NewtonMidpoint, and keeps angular momentum") {
  const double truth = closed_form(0.7);
  const double coarse = std::abs(wheels<NewtonMidpoint>(0.7, 5e-3).first - truth), fine = std::abs(wheels<NewtonMidpoint>(0.7, 2.5e-3).first - truth);
  CAPTURE(truth, coarse, fine);
  CHECK(fine < 1e-4);
  CHECK(coarse / fine == Approx(4).epsilon(0.05));
  const auto [turn, spin] = wheels<NewtonMidpoint>(0.7, 1e-3);
  CHECK(std::abs(turn - truth) < 1e-5);
  CHECK(std::abs(spin) < 1e-13);
}

TEST_CASE("a rotor is of first order with one solve a step") {
  const double truth = closed_form(0.7);
  const auto error = [&]<class Integrator>(Integrator, double h) { return std::abs(wheels<Integrator>(0.7, h).first - truth); };
  CHECK(error(SymplecticEuler{}, 1e-3) / error(SymplecticEuler{}, 5e-4) == Approx(2).epsilon(0.1));
  CHECK(error(SymplecticEuler{}, 1e-3) < 2e-2);
  CHECK(error(ImplicitMidpoint{}, 1e-3) < 2e-2);
  CHECK(std::abs(wheels<SymplecticEuler>(0.7, 1e-3).second) < 1e-12);
}

// A rod on a hinge whose rotor weighs on the swing alone: θ'' = −m g l sin θ/(I + m l² + I_r), over many turns too.
TEST_CASE("a pendulum with a rotor keeps its energy, the rotor's included") {
  AnimationLoop loop{World{RigidBodies{}}, Constraints{Hinge{}, RotorInertia<Turn>{}}, NewtonMidpoint{}};
  auto& set = bodies<RigidBodies>(loop.world());
  const auto rod = set.add({.position = {1, 0, 0}, .mass = 2.0, .inertia = Mat3(0.1 * Mat3::Identity())});
  const Quat axis = frame_along({0, 1, 0});
  const Anchor a = world_anchor({0, 0, 0}, axis), b = anchor_at(set, rod, {0, 0, 0}, axis);
  loop.add(Hinge::Item{a, b});
  loop.add(RotorInertia<Turn>::Item{.a = a, .b = b, .inertia = 3});
  const double start = potential_energy(set);
  double most = 0, fastest = 0;
  for (int n = 0; n < 5000; ++n) {
    loop.step(2e-3);
    const double rate = set.velocity()[0][4];
    most = std::max(most, std::abs(kinetic_energy(set) + potential_energy(set) + 0.5 * 3 * rate * rate - start));
    fastest = std::max(fastest, std::abs(rate));
  }
  CHECK(fastest == Approx(std::sqrt(2 * 2 * 9.81 / (2 + 0.1 + 3))).epsilon(1e-4));  // m g l = ½ (m l² + I + I_r) θ̇² at the lowest point
  CHECK(most < 1e-4 * 2 * 9.81);
}

TEST_CASE("a rotor refuses an inertia that is none") {
  AnimationLoop loop{World{RigidBodies{}}, Constraints{RotorInertia<Slide>{}}};
  auto& set = bodies<RigidBodies>(loop.world());
  const Anchor a = world_anchor({0, 0, 0}), b = anchor(set, set.add({.mass = 1.0, .shape = Sphere{1}}));
  for (const double wrong : {0.0, -1.0, 1e30, double(NAN)})
    CHECK_THROWS_WITH(loop.add(RotorInertia<Slide>::Item{.a = a, .b = b, .inertia = wrong}), Catch::Contains("inertia"));
}

}  // namespace rotor_inertia_tests
