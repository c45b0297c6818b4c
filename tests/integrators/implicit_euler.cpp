#include <delassus/integrators/implicit_euler.hpp>

#include "catch.hpp"
#include "integrators/free_fall.hpp"
#include "integrators/oscillator.hpp"

using namespace delassus;

// As for symplectic Euler: the force is constant. 60 steps round v and x once each.
TEST_CASE("a body falls by g h^2 n(n+1)/2 in n steps of implicit Euler") {
  const double h = 1.0 / 60;
  REQUIRE(free_fall::worst_error(ImplicitEuler{}, 60,
                                 [&](int n) { return -free_fall::g * h * h * n * (n + 1) / 2; }) <= 1e-13);
}

// One step is (x, v/ω) ← (1 − i h ω)⁻¹: x_n = (1 + h²ω²)^(−n/2) cos(n atan(h ω)). 1000 roundings of a
// decaying quantity stay below 1000 · 2^-53 of its start.
TEST_CASE("implicit Euler damps an oscillator by (1 + h^2 w^2)^(-1/2) a step") {
  const double h = 0.01, a = h * oscillator::omega;
  auto [loop, mass] = oscillator::make(ImplicitEuler{}, oscillator::omega);
  auto& set = bodies<Particles>(loop.world());
  double amplitude = 0;
  for (int n = 1; n <= 1000; ++n) {
    loop.step(h);
    const double x = set.position(mass).x(), v = set.velocity(mass).x() / oscillator::omega;
    amplitude = std::hypot(x, v);
    REQUIRE(std::abs(amplitude - std::pow(1 + a * a, -n / 2.0)) <= 1e-12);
    REQUIRE(std::abs(x - amplitude * std::cos(n * std::atan(a))) <= 1e-12);
  }
  REQUIRE(amplitude == Approx(0.13945).epsilon(1e-4));  // the reference's five digits
}

// |1/(1 − i h ω)| = 1e-6 of the amplitude √(x² + v²/ω²). x + h v cancels to 1e-12 of its terms, which leaves
// x four digits, and half of the next v comes from x.
TEST_CASE("implicit Euler brings an oscillator of h w = 1e6 to rest, by a factor of 1e-6 a step") {
  auto [loop, mass] = oscillator::make(ImplicitEuler{}, 1e6);
  auto& set = bodies<Particles>(loop.world());
  double last = 1;
  for (int n = 0; n < 20; ++n) {
    loop.step(1.0);
    const double amplitude = std::hypot(set.position(mass).x(), set.velocity(mass).x() / 1e6);
    REQUIRE(amplitude <= 1.001e-6 * last);
    last = amplitude;
  }
}

// m (1 + α h) v⁺ = m v − h k (x + h v⁺) − β h k v⁺ for C = α M + β K.
TEST_CASE("Rayleigh damping is alpha M + beta K") {
  const double h = 0.02, alpha = 0.7, beta = 0.03, k = 90, m = 1;
  auto [loop, mass] =
      oscillator::make(ImplicitEuler{.rayleigh_mass = alpha, .rayleigh_stiffness = beta}, std::sqrt(k));
  auto& set = bodies<Particles>(loop.world());
  double x = 1, v = 0;
  for (int n = 0; n < 200; ++n) {
    v = (m * v - h * k * x) / (m + h * alpha * m + h * h * k + h * beta * k);
    x += h * v;
    loop.step(h);
    REQUIRE(std::abs(set.position(mass).x() - x) <= 1e-13);  // 200 roundings of numbers below 1
  }
}
