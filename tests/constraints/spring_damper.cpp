#include <delassus/constraints/joints/spring_damper.hpp>
#include <delassus/delassus.hpp>
#include <delassus/steppers/newton_midpoint.hpp>

#include "catch.hpp"

#include <cmath>

namespace spring_damper_tests {

using namespace delassus;

namespace {

constexpr double stiffness = 40, moment = 0.5;  // N·m/rad, kg·m² about the hinge

/// A wheel on a hinge without gravity, turned by a radian; how far it is from its rest after `end` s.
template <class Integrator>
double angle(double damping, double end, double h, double* energy = nullptr) {
  AnimationLoop loop{World{RigidBodies{}}, Constraints{Hinge{}, SpringDamper<Turn>{}}, Integrator{}};
  auto& set = bodies<RigidBodies>(loop.world());
  set.gravity.setZero();
  const auto wheel = set.add({.mass = 1.0, .inertia = Mat3(moment * Mat3::Identity())});
  const Anchor a = world_anchor({0, 0, 0}), b = anchor(set, wheel);
  loop.add(Hinge::Item{a, b});
  loop.add(SpringDamper<Turn>::Item{.a = a, .b = b, .rest = -1, .stiffness = stiffness, .damping = damping});
  for (long n = std::lround(end / h); n > 0; --n) loop.step(h);
  const double q = Turn::value({a, b, loop.world()}) + 1;
  if (energy) *energy = kinetic_energy(set) + 0.5 * stiffness * q * q;
  return q;
}

/// q of I q̈ + c q̇ + k q = 0 from 1 at rest.
double closed_form(double damping, double t) {
  const double decay = damping / (2 * moment), w = std::sqrt(stiffness / moment - decay * decay);
  return std::exp(-decay * t) * (std::cos(w * t) + decay / w * std::sin(w * t));
}

}  // namespace

TEST_CASE("a spring and a damper on a hinge swing as the closed form, at order two under NewtonMidpoint") {
  const double truth = closed_form(1, 0.7);
  const double coarse = std::abs(angle<NewtonMidpoint>(1, 0.7, 5e-3) - truth), fine = std::abs(angle<NewtonMidpoint>(1, 0.7, 2.5e-3) - truth);
  CAPTURE(coarse, fine);
  CHECK(coarse / fine == Approx(4).epsilon(0.05));
  CHECK(std::abs(angle<NewtonMidpoint>(1, 0.7, 1e-3) - truth) < 1e-4);
  CHECK(std::abs(angle<SymplecticEuler>(1, 0.7, 1e-4) - truth) < 5e-3);  // of first order
}

// An angle is no square of the axes, so that the work of its spring is met to second order in the step, and nothing adds up.
TEST_CASE("NewtonMidpoint keeps the energy of a spring without a damper to second order, for long") {
  const auto change = [](double end, double h) {
    double energy = 0;
    angle<NewtonMidpoint>(0, end, h, &energy);
    return std::abs(energy / (0.5 * stiffness) - 1);
  };
  CHECK(change(20, 1e-2) < 2e-5);
  CHECK(change(200, 1e-2) < 2e-5);
  CHECK(change(20, 1e-3) < 2e-7);
}

TEST_CASE("a spring between two points has its rest length") {
  AnimationLoop loop{World{Particles{}}, Constraints{SpringDamper<Length>{}}};
  auto& set = bodies<Particles>(loop.world());
  const auto bob = set.add({.position = {0, 0, -1}, .mass = 2.0});
  loop.add(SpringDamper<Length>::Item{.a = world_anchor({0, 0, 0}), .b = anchor(set, bob), .rest = 1, .stiffness = 500, .damping = 20, .position = 1});
  for (int n = 0; n < 3000; ++n) loop.step(5e-3);
  CHECK(set.pose(0).position.z() == Approx(-1 - 2 * 9.81 / 500).margin(1e-9));  // f = 500 (l − 1) carries 2 kg
}

TEST_CASE("a spring refuses numbers that mean nothing") {
  AnimationLoop loop{World{RigidBodies{}}, Constraints{SpringDamper<Slide>{}}};
  auto& set = bodies<RigidBodies>(loop.world());
  const Anchor a = world_anchor({0, 0, 0}), b = anchor(set, set.add({.mass = 1.0, .shape = Sphere{1}}));
  using Item = SpringDamper<Slide>::Item;
  CHECK_THROWS_WITH(loop.add(Item{.a = a, .b = b}), Catch::Contains("both 0"));
  CHECK_THROWS_WITH(loop.add(Item{.a = a, .b = b, .stiffness = -1}), Catch::Contains("stiffness") && Catch::Contains("N/m"));
  CHECK_THROWS_WITH(loop.add(Item{.a = a, .b = b, .damping = 1e30}), Catch::Contains("damping"));
  CHECK_THROWS_WITH(loop.add(Item{.a = a, .b = b, .rest = NAN, .stiffness = 1}), Catch::Contains("rest"));
}

}  // namespace spring_damper_tests
