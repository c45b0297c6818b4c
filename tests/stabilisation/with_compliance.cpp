#include <delassus/stabilisation/with_compliance.hpp>

#include "catch.hpp"
#include "scenes.hpp"

using namespace scenes;

namespace {

/// The depth to which a box of 2 kg on its four corners has come to rest.
template <class S>
double depth(const S& stabilisation, double h) {
  AnimationLoop loop{World{RigidBodies{}}, Constraints{Contact{Coulomb{.friction = 0.5}}}, stabilisation,
                     AcceleratedGaussSeidel{.tolerance = 1e-10}};
  auto& set = rigid_bodies(loop);
  set.add_fixed(HalfSpace{});
  const auto box = set.add({.position = {0, 0, 0.5}, .mass = 2.0, .shape = Box{1, 1, 1}});
  for (int n = 0; n < int(3 / h); ++n) loop.step(h);
  REQUIRE(loop.report().status < Status::max_iterations);
  return 0.5 - set.position(box).z();
}

}  // namespace

// Four springs of C share m g: each gives way by C m g/4. The approach is geometric with 0.8 a step at rate
// 0.2 and faster otherwise: after three seconds nothing is left of it.
TEST_CASE("a box comes to rest as deep as its compliance says, at every step and rate") {
  const double C = 1e-5, expected = C * 2 * g / 4;
  for (const double h : {0.02, 0.01, 0.005}) {
    REQUIRE(depth(WithCompliance{Baumgarte{}, C}, h) == Approx(expected).epsilon(1e-3));
    REQUIRE(depth(WithCompliance{WholeViolation{}, C}, h) == Approx(expected).epsilon(1e-3));
  }
}

TEST_CASE("no compliance is the stabilisation alone, to the bit") {
  REQUIRE(depth(WithCompliance{Baumgarte{}, 0}, 0.01) == depth(Baumgarte{}, 0.01));
}

// Each rod is off by half a metre at rest: f = 0.5 m/C.
TEST_CASE("rods that contradict each other pull like springs of the compliance, and the solve converges") {
  constexpr double C = 1e-4, h = 0.01;
  AnimationLoop loop{World{RigidBodies{}}, Constraints{DistanceJoint{}}, WithCompliance{Baumgarte{}, C}};
  auto& set = rigid_bodies(loop);
  set.gravity.setZero();
  const auto ball = set.add({.position = {1.5, 0, 0}, .mass = 1.0, .shape = Sphere{0.1}});
  const auto shorter = loop.add(DistanceJoint::Item{anchor(set, ball), world_anchor({0, 0, 0}), 1});
  const auto longer = loop.add(DistanceJoint::Item{anchor(set, ball), world_anchor({0, 0, 0}), 2});
  for (int n = 0; n < 100; ++n) REQUIRE(loop.step(h).status == Status::converged);
  REQUIRE(set.position(ball).x() == Approx(1.5).epsilon(1e-6));
  REQUIRE(std::abs(loop.impulse(longer)[0]) == Approx(0.5 / C * h).epsilon(1e-4));
  REQUIRE(loop.impulse(shorter)[0] == Approx(-loop.impulse(longer)[0]).epsilon(1e-4));
}

TEST_CASE("a compliance below zero or infinite is refused") {
  REQUIRE_THROWS_WITH((WithCompliance{Baumgarte{}, -1.}.check()),
                      Catch::Contains("WithCompliance: compliance -1 m/N"));
  REQUIRE_THROWS_WITH((WithCompliance{Baumgarte{}, INFINITY}.check()), Catch::Contains("must be finite"));
}
