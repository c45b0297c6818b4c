#include <delassus/stabilisation/baumgarte.hpp>

#include "catch.hpp"
#include "stabilisation/violated.hpp"

using namespace delassus;

// φ₊ = φ + h u⁺ = (1 − rate) φ: a geometric series, each term rounded once.
TEST_CASE("Baumgarte takes its rate of a joint's violation back, each step") {
  for (const double rate : {0.1, 0.2, 0.5, 1.0}) {
    violated::Joint scene(Baumgarte{.rate = rate});
    double expected = 0.1;
    for (int n = 0; n < 30; ++n) {
      scene.loop.step(0.01);
      expected *= 1 - rate;
      CAPTURE(rate, n);
      REQUIRE(std::abs(scene.set().position(scene.bob).x() - expected) <= 1e-16);
    }
  }
}

TEST_CASE("Baumgarte does not depend on the step: the rate is per step") {
  for (const double h : {1e-4, 1e-2, 1.0}) {
    violated::Joint scene(Baumgarte{.rate = 0.2});
    scene.loop.step(h);
    CHECK(scene.set().position(scene.bob).x() == Approx(0.08).epsilon(1e-14));
  }
}

TEST_CASE("an overlap shrinks by Baumgarte's rate, below the cap") {
  violated::Sunk scene(Baumgarte{.rate = 0.2, .max_speed = 1}, 0.01);
  const double h = 0.01;  // 0.2 · 0.01/0.01 = 0.2 m/s
  double expected = 0.01;
  for (int n = 0; n < 10; ++n) {
    scene.loop.step(h);
    expected *= 0.8;
    REQUIRE(scene.depth() == Approx(expected).epsilon(1e-9));  // 10 roundings of 0.5 m against 1e-3 m
  }
}

TEST_CASE("an overlap is pushed out no faster than Baumgarte's cap, whatever the step") {
  for (const double h : {1e-4, 1e-3, 1e-2}) {
    violated::Sunk scene(Baumgarte{.rate = 0.5, .max_speed = 0.3}, 0.2);
    CAPTURE(h);
    CHECK(scene.exit_speed(h, 50) == Approx(0.3).epsilon(1e-12));
  }
}
