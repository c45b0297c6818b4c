#include "scenes.hpp"

#include <delassus/constraints/contact/pyramid.hpp>

#include "catch.hpp"

#include <cmath>

namespace pyramid_tests {

using namespace scenes;

namespace {

constexpr double h = 1.0 / 60, mu = 0.3, v0 = 5;

struct Ride {
  Vec3 x;            ///< where the block stopped
  double off = 0;    ///< of the discrete law, m/s, at any step
  double speed = 0;  ///< left at the end, m/s
};

/// A flat block on the floor, set off under an angle with the x axis.
Ride slide(double angle) {
  AnimationLoop loop{World{RigidBodies{}}, Constraints{Contact{Pyramid{.friction = mu}}},
                     AcceleratedGaussSeidel{.tolerance = 1e-13}};
  auto& set = rigid_bodies(loop);
  set.add_fixed(HalfSpace{});
  const auto block = set.add({.position = {0, 0, 0.1},
                              .velocity = {v0 * std::cos(angle), v0 * std::sin(angle), 0},
                              .mass = 1.0,
                              .shape = Box{1, 1, 0.2}});
  Ride ride;
  for (int n = 1; n <= 120; ++n) {
    loop.step(h);
    const Vec3 v(std::max(v0 * std::cos(angle) - n * mu * g * h, 0.0),
                 std::max(v0 * std::sin(angle) - n * mu * g * h, 0.0), 0);
    ride.off = std::max(ride.off, (set.velocity(block) - v).norm());
  }
  ride.x = set.position(block) - Vec3(0, 0, 0.1);
  ride.speed = set.velocity(block).norm();
  return ride;
}

}  // namespace

// Either component loses mu g h a step by itself and stops by itself: what the discrete law of one block
// gives. A tolerance of 1e-13 and 120 steps leave 1e-11 m/s. In the limit of small steps the way is v²/(2 mu
// g) times √(cos⁴ + sin⁴), first order in h.
TEST_CASE("under a pyramid either component of the velocity stops by itself, at any heading") {
  const double cone = v0 * v0 / (2 * mu * g);
  for (int degrees = 0; degrees <= 45; degrees += 15) {
    const double angle = degrees * M_PI / 180;
    const Ride ride = slide(angle);
    CAPTURE(degrees);
    REQUIRE(ride.off <= 1e-11);
    REQUIRE(ride.speed <= 1e-15 * v0);
    const double share = std::hypot(std::pow(std::cos(angle), 2), std::pow(std::sin(angle), 2));
    REQUIRE(ride.x.norm() == Approx(share * cone).epsilon(0).margin(v0 * h));
    REQUIRE(ride.x.norm() >= cone / std::sqrt(2.0) - v0 * h);
  }
  REQUIRE(slide(M_PI / 4).x.norm() < 0.75 * cone);  // a round cone is another law
}

// The law is met to the rounding of one 3 × 3 solve: 1e-11 of the free velocity for blocks whose condition is
// below 1e3.
TEST_CASE("one visit of a pyramid meets its law, whatever sticks or slips") {
  std::mt19937 random(3);
  const auto draw = [&] { return 2 * double(random()) / 4294967295.0 - 1; };
  int slipping[3] = {}, open = 0;
  for (int k = 0; k < 2000; ++k) {
    Mat3 G;
    for (int i = 0; i < 3; ++i)
      for (int j = 0; j < 3; ++j) G(i, j) = 0.3 * draw();
    Mat3 W = G * G.transpose();
    for (int i = 0; i < 3; ++i) W(i, i) += 1;
    Vec3 b;
    for (int i = 0; i < 3; ++i) b[i] = draw();
    const Pyramid law;
    const Pyramid::Parameters p{0.1 + 0.9 * std::abs(draw())};
    const Vec3 lambda = law.solve_local(p, W, b), u = W * lambda + b;
    REQUIRE(law.natural_map(p, lambda, u, 1.0).norm() <= 1e-11 * b.norm());
    if (lambda[0] == 0)
      ++open;
    else
      ++slipping[(std::abs(lambda[1]) >= p.slope * lambda[0] * (1 - 1e-12)) +
                 (std::abs(lambda[2]) >= p.slope * lambda[0] * (1 - 1e-12))];
  }
  for (const int seen : {open, slipping[0], slipping[1], slipping[2]})
    REQUIRE(seen > 50);  // every case was met
}

}  // namespace pyramid_tests
