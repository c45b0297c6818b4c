#include <delassus/constraints/rebound.hpp>

#include <cmath>
#include <random>

#include "catch.hpp"

namespace rebound_tests {

using namespace delassus;

namespace {

constexpr double g = 9.81, h = 1.0 / 60;

/// A body that falls and moves by u.
Closing falling(double gap, double velocity, bool may_land) {
  return {.gap = gap, .velocity = velocity, .acceleration = -g, .height = gap, .least = g * h / 2, .h = h, .may_land = may_land};
}

}  // namespace

// Sums and roots of a few numbers: 1e-12 of the energy.
TEST_CASE("a rebound keeps e^2 of the energy that a falling body has at the surface, from above it and from below") {
  std::mt19937 random(5);
  const auto draw = [&](double low, double high) { return std::uniform_real_distribution<double>(low, high)(random); };
  int bounced = 0, landed = 0;
  for (int k = 0; k < 2000; ++k) {
    const double e = draw(0, 1), v = -draw(0, 5), x = draw(-0.5, 1) * h * (-v);
    const double met = 0.5 * v * v + g * x;  // ½ V_s²
    const Rebound is = rebound(falling(x, v, k % 2 == 0), e);
    CAPTURE(e, v, x);
    if (is.leaves > 0) {
      const double starts = is.leaves + g * h / 2;
      CHECK(0.5 * starts * starts + g * x == Approx(e * e * met).epsilon(1e-12));
      ++bounced;
    } else if (is.parts > 0) {
      CHECK(0.5 * is.parts * is.parts == Approx(e * e * met).epsilon(1e-12));
      ++landed;
    }
    CHECK((is.leaves == 0 || is.parts == 0));
    CHECK(is.leaves <= std::max(0.0, -v) + 1e-12);
    if (k % 2 == 1) CHECK(is.parts == 0);
  }
  REQUIRE(bounced > 500);
  REQUIRE(landed > 100);
}

TEST_CASE("a rebound gives e v back where nothing accelerates") {
  const Closing steady{.gap = 0.01, .velocity = -3, .acceleration = 0, .height = 0.01, .least = 0, .h = h, .may_land = true};
  for (const double e : {0.0, 0.3, 1.0}) CHECK(rebound(steady, e).leaves == Approx(3 * e).epsilon(1e-15));
}

// Where a body bounces at once it misses the flight to the surface and back, where it lands the rest of the step. The
// smaller error is taken: with up ≤ the time of the flight from the surface it is less than a step.
TEST_CASE("a rebound is less than a step early or late") {
  for (int k = 0; k < 1000; ++k) {
    const double e = 0.3 + 0.7 * (k % 10) / 10, v = -1 - 0.004 * k, x = h * (-v) * (k % 97) / 97;
    const Rebound is = rebound(falling(x, v, true), e);
    const double meets = std::sqrt(v * v + 2 * g * x), down = (meets + v) / g;
    CAPTURE(e, v, x);
    if (is.leaves > 0) {
      const double up = (e * meets - (is.leaves + g * h / 2)) / g;
      CHECK(down + up < h);
    } else {
      REQUIRE(is.parts > 0);
      CHECK(h - down < h + 1e-12);
    }
  }
}

TEST_CASE("a body that would part with less than half a step's fall stays") {
  const Rebound is = rebound(falling(0, -1, true), 0.99 * g * h / 2);
  CHECK(is.leaves == 0);
  CHECK(is.parts == 0);
}

}  // namespace rebound_tests
