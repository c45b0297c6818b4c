#include <delassus/stabilisation/position_projection.hpp>

#include "catch.hpp"
#include "stabilisation/violated.hpp"

using namespace delassus;

TEST_CASE("position projection closes a joint by its rate and gives it no velocity, to the bit") {
  violated::Joint scene(PositionProjection{.rate = 0.25});
  double expected = 0.1;
  for (int n = 0; n < 20; ++n) {
    scene.loop.step(0.01);
    expected *= 0.75;
    REQUIRE(scene.set().velocity(scene.bob) == Vec3::Zero());
    REQUIRE(std::abs(scene.set().position(scene.bob).x() - expected) <= 1e-15);
  }
}

TEST_CASE("position projection lifts a sunk body and leaves it at rest") {
  violated::Sunk scene(PositionProjection{.rate = 0.2}, 0.01);
  double expected = 0.01;
  for (int n = 0; n < 10; ++n) {
    scene.loop.step(0.01);
    expected *= 0.8;
    // The contact carries the weight, m g h, and no more: a rounding of it is all the velocity there is.
    REQUIRE(scene.set().velocity(scene.ball).norm() <= 1e-16);
    REQUIRE(scene.depth() == Approx(expected).epsilon(1e-9));
  }
}

TEST_CASE("position projection moves an overlap apart no faster than its cap") {
  violated::Sunk scene(PositionProjection{.rate = 1, .max_speed = 0.3}, 0.2);
  const double h = 0.01;
  for (int n = 1; n <= 20; ++n) {
    scene.loop.step(h);
    REQUIRE(scene.depth() == Approx(0.2 - 0.3 * h * n).epsilon(1e-9));
  }
}

// Without a violation there is nothing to project: the trajectories agree to the rounding of a displacement
// of zero.
TEST_CASE("position projection changes nothing where nothing is violated") {
  violated::Joint projected(PositionProjection{}, 0.0);
  violated::Joint plain(Baumgarte{}, 0.0);
  for (int n = 0; n < 100; ++n) {
    projected.loop.step(0.01);
    plain.loop.step(0.01);
  }
  CHECK(projected.set().position(projected.bob) == plain.set().position(plain.bob));
}
