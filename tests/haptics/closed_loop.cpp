#include "wall.hpp"

#include "catch.hpp"

#include <algorithm>

using namespace wall;

namespace {

/// The smallest value of the observer's energy with the device's friction counted in, J.
double least_energy(const std::vector<Sample>& samples) {
  double least = 0;
  for (const Sample& s : samples) least = std::min(least, s.energy + s.friction);
  return least;
}

}  // namespace

TEST_CASE("a stiff wall at 1 kHz is passive and at rest, where the loop's force at 30 Hz swings") {
  const auto ticks = press({.max_force = 8}), direct = press({.display = Display::direct, .max_force = 8});
  // b = k T/2 + c: docs/theory/haptics.md derives that then no energy comes out. Rounding: 3000 sums of 1e-3 J.
  CHECK(least_energy(ticks) >= -1e-12);
  // The slowest mode, K + k against b + B, decays like exp(−t (b + B)/2m) = e^(−14 t): two seconds after the touch to 1e-12
  // of 3 cm.
  CHECK(swing(ticks) < 1e-9);
  // Rest: K (x_h − x) + k (radius − x) = 0, x_h = 0.
  CHECK(ticks.back().position == Approx(1000 * radius / 1300).epsilon(1e-6));
  CHECK(ticks.back().force == Approx(300 * 1000 * radius / 1300).epsilon(1e-6));

  // The same wall, the same k, from the loop: k T/2 = 16 N·s/m stands against friction and hand of 2.8.
  CHECK(least_energy(direct) < -1);
  CHECK(swing(direct) > 0.02);
}

TEST_CASE("snapshots of any age up to 100 ms leave the wall passive, at rest, and of the same force") {
  for (const int age : {1, 2, 5, 10, 17, 33, 50, 66, 83, 100}) {
    CAPTURE(age);
    const auto samples = press({.age = age});
    CHECK(least_energy(samples) >= -1e-12);
    CHECK(swing(samples) < 1e-9);
    CHECK(samples.back().force == Approx(300 * 1000 * radius / 1300).epsilon(1e-6));
    for (const Sample& s : samples) REQUIRE(s.status <= Status::stalled);
  }
}

TEST_CASE("a wall with friction is passive too") {
  const auto samples = press({.wall_friction = 0.5});
  CHECK(least_energy(samples) >= -1e-12);
  CHECK(swing(samples) < 1e-9);
}

TEST_CASE("a coupling too stiff for friction and hand together gives energy out: the tests above could fail") {
  const auto samples = press({.stiffness = 10000, .max_force = 8});  // k T/2 = 5 N·s/m against b + B = 2.8
  CHECK(least_energy(samples) < -1e-3);
  CHECK(swing(samples) > 1e-4);
}
