#include <delassus/integrators/symplectic_euler.hpp>

#include "catch.hpp"
#include "integrators/free_fall.hpp"
#include "integrators/oscillator.hpp"

using namespace delassus;

// Each of 60 steps rounds v and x once: 60 · 2^-53 < 1e-14; ten times that for the first, short falls.
TEST_CASE("a body falls by g h^2 n(n+1)/2 in n steps of symplectic Euler") {
  const double h = 1.0 / 60;
  REQUIRE(free_fall::worst_error(SymplecticEuler{}, 60,
                                 [&](int n) { return -free_fall::g * h * h * n * (n + 1) / 2; }) <= 1e-13);
}

// x_n = cos((n + 1/2) θ)/cos(θ/2) with sin(θ/2) = h ω/2; θ/(h ω) is the reference's ratio of frequencies.
// 1000 steps round x and v by 2^-53 each, and a rounding stays a rounding: 1000 · 2 · 2^-53 ~ 2e-13.
TEST_CASE("symplectic Euler oscillates too fast by the factor of its closed form, at full amplitude") {
  const double h = 0.01, turn = 1.0001645665064487 * oscillator::omega * h;
  auto [loop, mass] = oscillator::make(SymplecticEuler{}, oscillator::omega);
  auto& set = bodies<Particles>(loop.world());
  for (int n = 1; n <= 1000; ++n) {
    loop.step(h);
    REQUIRE(std::abs(set.position(mass).x() - std::cos((n + 0.5) * turn) / std::cos(turn / 2)) <= 1e-12);
  }
}

// The quadratic form is invariant under the linear map of a step; 1000 steps round it by 2^-53 of its terms
// each, without bias: √1000 · 2^-53 · 4 terms ~ 1.4e-14 of its value.
TEST_CASE("symplectic Euler keeps v^2 + w^2 x^2 - h w^2 x v") {
  const double h = 0.01, w2 = oscillator::omega * oscillator::omega;
  auto [loop, mass] = oscillator::make(SymplecticEuler{}, oscillator::omega);
  auto& set = bodies<Particles>(loop.world());
  for (int n = 1; n <= 1000; ++n) {
    loop.step(h);
    const double x = set.position(mass).x(), v = set.velocity(mass).x();
    REQUIRE(v * v + w2 * x * x - h * w2 * x * v == Approx(w2).epsilon(1e-13));
  }
}

TEST_CASE("symplectic Euler is bounded at h w = 1.99 and grows at 2.01") {
  // The amplitude is 1/cos(θ/2) with sin(θ/2) = 0.995: 10.0126. Beyond 2 each step multiplies by 1.22.
  for (const double edge : {1.99, 2.01}) {
    auto [loop, mass] = oscillator::make(SymplecticEuler{}, edge);
    auto& set = bodies<Particles>(loop.world());
    double largest = 0;
    for (int n = 0; n < 10000 && largest < 1e6; ++n) {
      loop.step(1.0);
      largest = std::max(largest, std::abs(set.position(mass).x()));
    }
    CAPTURE(edge);
    if (edge < 2)
      REQUIRE(largest <= 10.0126);
    else
      REQUIRE(largest >= 1e6);
  }
}
