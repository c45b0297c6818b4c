#include <delassus/haptics/passivity_observer.hpp>
#include <delassus/haptics/simulated_device.hpp>

#include "catch.hpp"

#include <cmath>

using namespace delassus;

TEST_CASE("a device without friction and damping keeps its energy and what the force gives it") {
  SimulatedDevice device{.friction = 0, .hand_damping = 0, .position = {0.02, 0, -0.01}};
  const double start = device.energy();
  double work = 0;
  for (int n = 0; n < 2000; ++n) {
    const Vec3 force(std::sin(0.1 * n), 0.5, 0), before = device.position;
    device.advance(force, 1e-3);
    work += force.dot(device.position - before);
  }
  // The midpoint rule keeps the balance exactly; 20000 steps of rounding 1e-16 on energies of 0.1 J.
  REQUIRE(std::abs(device.energy() - start - work) < 1e-12);
  REQUIRE(std::abs(work) > 1e-4);
}

TEST_CASE("friction takes exactly what is counted as lost") {
  SimulatedDevice device{.friction = 1.5, .hand_damping = 0, .position = {0.02, 0, 0}};
  const double start = device.energy();
  for (int n = 0; n < 500; ++n) device.advance(Vec3::Zero(), 1e-3);
  REQUIRE(std::abs(start - device.energy() - device.lost_to_friction) < 1e-14);
  REQUIRE(device.lost_to_friction > 0.9 * start);
}

TEST_CASE("a simulated device converges to the closed form with order two") {
  // m ẍ + (b + B) ẋ + K x = 0 from x = 1 cm at rest: e^(−γt)(cos Ωt + γ/Ω sin Ωt), γ = (b + B)/2m, Ω² = K/m − γ².
  const double gamma = 3 / 0.2, omega = std::sqrt(300 / 0.1 - gamma * gamma), t = 0.05;
  const double exact = 0.01 * std::exp(-gamma * t) * (std::cos(omega * t) + gamma / omega * std::sin(omega * t));
  const auto error = [&](int steps) {
    SimulatedDevice device{.position = {0.01, 0, 0}};
    device.advance(Vec3::Zero(), t, steps);
    return std::abs(device.position.x() - exact);
  };
  const double slope = std::log2(error(100) / error(200));
  REQUIRE(slope == Approx(2).margin(0.05));  // the next term is of order four: a share of (ω dt)² < 1e-3
}

TEST_CASE("the hand moves with its velocity and takes the device along") {
  SimulatedDevice device{.hand_velocity = {0.1, 0, 0}};
  device.advance(Vec3::Zero(), 2.0, 20000);
  REQUIRE(device.hand.x() == Approx(0.2));
  // In steady motion the hand's spring carries the device's friction: K (x_h − x) = b v.
  REQUIRE(device.hand.x() - device.position.x() == Approx(1 * 0.1 / 300).epsilon(1e-6));
}

TEST_CASE("a passivity observer counts the work done against what is displayed") {
  PassivityObserver observer;
  observer.add({0, 0, 3}, {0, 0, -0.1});  // pressed in against 3 N: 0.3 J taken in
  REQUIRE(observer.energy() == Approx(0.3));
  REQUIRE(observer.is_passive());
  observer.add({0, 0, 5}, {0, 0, 0.1}, {0, 1, 0}, {0, 0.2, 0});  // pushed out with more: 0.5 J and 0.2 J given
  REQUIRE(observer.energy() == Approx(-0.4));
  REQUIRE_FALSE(observer.is_passive());
  observer.add({0, 0, 5}, {0, 0, -1});
  REQUIRE(observer.least() == Approx(-0.4));
  REQUIRE(observer.is_passive());
}

TEST_CASE("a device without mass is refused") {
  REQUIRE_THROWS_WITH(SimulatedDevice{.mass = 0}.check(),
                      "delassus: SimulatedDevice: mass 0 kg must be finite and > 0");
}
