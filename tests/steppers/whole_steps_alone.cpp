// Rattle and Runge-Kutta without a constraint: discrete closed forms, stability edges, the Euler top.
#include <delassus/steppers/rattle.hpp>
#include <delassus/steppers/runge_kutta4.hpp>

#include "catch.hpp"
#include "convergence_order.hpp"
#include "integrators/euler_top.hpp"
#include "integrators/free_fall.hpp"
#include "integrators/oscillator.hpp"

namespace whole_steps_alone_tests {

using namespace delassus;

// Exact for a constant force. 60 steps round v and x a few times each: 60 · 4 · 2^-53 of the fall's end, and
// its first step is 1/3600 of that.
TEMPLATE_TEST_CASE("a body falls by g t^2/2", "", Rattle, RungeKutta4) {
  const double h = 1.0 / 60;
  REQUIRE(free_fall::worst_error(TestType{}, 60, [&](int n) { return -free_fall::g * h * h * n * n / 2; }) <=
          1e-13);
}

// From rest x_n = cos(n θ), sin(θ/2) = h ω/2; 1000 roundings of 2^-53.
TEST_CASE("Rattle oscillates too fast by the factor of its closed form, at full amplitude") {
  const double h = 0.01, turn = 1.0001645665064487 * oscillator::omega * h;
  auto [loop, mass] = oscillator::make(Rattle{}, oscillator::omega);
  auto& set = bodies<Particles>(loop.world());
  for (int n = 1; n <= 1000; ++n) {
    loop.step(h);
    REQUIRE(std::abs(set.position(mass).x() - std::cos(n * turn)) <= 1e-12);
  }
}

// |1 + iz + … + (iz)⁴/24|² = 1 − z⁶/72 + z⁸/576, and its argument atan((z − z³/6)/(1 − z²/2 + z⁴/24)).
TEST_CASE("Runge-Kutta damps and turns an oscillator as the polynomial of its stability says") {
  const double h = 0.01, z = h * oscillator::omega;
  const double shrink = std::sqrt(1 - std::pow(z, 6) / 72 + std::pow(z, 8) / 576);
  const double turn = std::atan2(z - z * z * z / 6, 1 - z * z / 2 + z * z * z * z / 24);
  auto [loop, mass] = oscillator::make(RungeKutta4{}, oscillator::omega);
  auto& set = bodies<Particles>(loop.world());
  for (int n = 1; n <= 1000; ++n) {
    loop.step(h);
    REQUIRE(std::abs(set.position(mass).x() - std::pow(shrink, n) * std::cos(n * turn)) <= 1e-12);
  }
  REQUIRE(std::pow(shrink, 1000) == Approx(0.99999957).epsilon(1e-8));
}

namespace {

/// The largest |x| of an oscillator over steps of one second.
template <class Integrator>
double farthest(Integrator integrator, double edge) {
  auto [loop, mass] = oscillator::make(integrator, edge);
  auto& set = bodies<Particles>(loop.world());
  double largest = 0;
  for (int n = 0; n < 10000 && largest < 1e6; ++n) {
    loop.step(1.0);
    largest = std::max(largest, std::abs(set.position(mass).x()));
  }
  return largest;
}

}  // namespace

// Below 2 |x_n| = |cos nθ|; beyond, each step multiplies by 1.22. Runge-Kutta's edge is 2√2 = 2.82843: the
// factor at 2.84 is √(1 − z⁶/72 + z⁸/576) = 1.024, at 2.82 it is 0.984.
TEST_CASE("Rattle is bounded at h w = 1.99 and grows at 2.01, Runge-Kutta at 2.82 and 2.84") {
  CHECK(farthest(Rattle{}, 1.99) <= 1 + 1e-9);
  CHECK(farthest(Rattle{}, 2.01) >= 1e6);
  CHECK(farthest(RungeKutta4{}, 2.82) <= 1);
  CHECK(farthest(RungeKutta4{}, 2.84) >= 1e6);
}

TEST_CASE(
    "the Euler top is met by Rattle with second order, by Runge-Kutta with fourth, within their constants") {
  const auto of = [](auto integrator) {
    return [=](double h) { return euler_top::after_ten_seconds(integrator, int(std::lround(10 / h))).angle; };
  };
  CHECK(are_of_order(convergence_orders(of(Rattle{}), 1.0 / 40), 2));
  CHECK(are_of_order(convergence_orders(of(RungeKutta4{}), 1.0 / 20), 4));
  CHECK(of(Rattle{})(1.0 / 160) <= 1.5 * 2.14e-5);
  CHECK(of(RungeKutta4{})(1.0 / 160) <= 1.5 * 2.86e-10);
  CHECK(euler_top::after_ten_seconds(Rattle{}, 1600).momentum <= 1600 * 8 * 0x1p-53);
}

}  // namespace whole_steps_alone_tests
