#include <delassus/stabilisation/soft_contact.hpp>

#include "catch.hpp"
#include "stabilisation/violated.hpp"

using namespace delassus;

// At rest λ = m g h = −φ k h with k = m ω²: φ = −g/ω². The transient decays like e^(−ζ ω t) or faster, ω >=
// 31/s: after 2 s nothing is left of it at double precision but rounding of 0.5 m against the sag.
TEST_CASE("a body on soft contact sags by g/w^2, whatever its mass, damping and step") {
  for (const double frequency : {5.0, 10.0, 30.0})
    for (const double damping_ratio : {0.5, 1.0, 2.0})
      for (const double h : {1e-3, 1.0 / 60}) {
        violated::Sunk scene(SoftContact{.frequency = frequency, .damping_ratio = damping_ratio}, 1e-6);
        for (int n = 0; n < int(4 / h); ++n) scene.loop.step(h);
        const double omega = 6.283185307179586 * frequency;
        CAPTURE(frequency, damping_ratio, h);
        CHECK(scene.depth() == Approx(9.81 / (omega * omega)).epsilon(1e-6));
      }
}

// Implicit Euler of m ẍ = −k φ − c ẋ − m g, as the class states it.
TEST_CASE("a sunk body moves on soft contact as on implicit Euler's damped spring") {
  const double h = 0.005, frequency = 4, zeta = 0.3, omega = 6.283185307179586 * frequency;
  const double m = 1, k = m * omega * omega, c = 2 * zeta * m * omega;
  violated::Sunk scene(SoftContact{.frequency = frequency, .damping_ratio = zeta, .max_speed = 1e3}, 0.1);
  double phi = -0.1, v = 0;
  for (int n = 0; n < 10; ++n) {
    const double next = (m * v - h * m * 9.81 - h * k * phi) / (m + h * h * k + h * c);
    // The row may only push: after the spring would pull, the contact opens.
    if (m * (next - v + 9.81 * h) < 0) break;
    v = next;
    phi += h * v;
    scene.loop.step(h);
    CAPTURE(n);
    REQUIRE(std::abs(-scene.depth() - phi) <= 1e-14);
  }
}

TEST_CASE("soft contact pushes out no faster than its cap") {
  violated::Sunk scene(SoftContact{.frequency = 30, .max_speed = 0.25}, 0.2);
  CHECK(scene.exit_speed(0.01, 50) <= 0.25 * (1 + 1e-12));
}
