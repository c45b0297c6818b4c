#include "scenes.hpp"

#include "catch.hpp"

namespace sliding_tests {

using namespace scenes;

namespace {

constexpr double h = 1.0 / 60;

/// A flat block of 1 kg on the plane z = 0, alone.
auto block_on_plane(double friction, double tolerance = 1e-6, const Vec3& at = {0, 0, 0.1}) {
  AnimationLoop loop{World{RigidBodies{}}, Constraints{Contact{Coulomb{.friction = friction}}},
                     AcceleratedGaussSeidel{.tolerance = tolerance}};
  auto& set = rigid_bodies(loop);
  set.add_fixed(HalfSpace{});
  set.add({.position = at, .mass = 1.0, .shape = Box{1, 1, 0.2}});
  return loop;
}

/// Tilting gravity instead of the plane: a slope of angle a, downhill along x.
Vec3 gravity_on_slope(double angle) { return {g * std::sin(angle), 0, -g * std::cos(angle)}; }

}  // namespace

// v_n = max(v_0 − n μ g h, 0): what the discrete law of one block gives. A tolerance of 1e-13 and 61 steps leave 1e-11 m/s.
TEST_CASE("a sliding block loses mu g h a step and stops in the step the discrete law says") {
  const double v0 = 5, mu = 0.3;
  auto loop = block_on_plane(mu, 1e-13);
  auto& set = rigid_bodies(loop);
  const auto block = set.handle(1);
  set.set_velocity(block, {v0, 0, 0});
  double x = 0;
  for (int n = 1; n <= 150; ++n) {
    loop.step(h);
    const double v = std::max(v0 - n * mu * g * h, 0.0);
    x += h * v;
    CAPTURE(n);
    REQUIRE(set.velocity(block).x() == Approx(v).epsilon(0).margin(1e-11));
    REQUIRE(set.position(block).x() == Approx(x).epsilon(0).margin(1e-10));
  }
  REQUIRE(x == Approx(v0 * v0 / (2 * mu * g)).epsilon(2 * h * mu * g / v0));  // first order of v0²/2μg
}

TEST_CASE("a block that has stopped has a velocity of zero, to 1e-15 of what it had") {
  auto loop = block_on_plane(0.3);
  auto& set = rigid_bodies(loop);
  const auto block = set.handle(1);
  set.set_velocity(block, {5, 0, 0});
  for (int n = 0; n < 200; ++n) loop.step(h);
  const Vec3 x = set.position(block);
  for (int n = 0; n < 1000; ++n) {
    loop.step(h);
    REQUIRE(set.velocity(block).norm() <= 1e-15 * 5);
  }
  REQUIRE((set.position(block) - x).norm() <= 1e-15 * 5 * 1000 * h);
}

TEST_CASE("a block on 30 degrees with friction 5 % above the tangent does not creep in 1000 s") {
  const double angle = M_PI / 6;
  auto loop = block_on_plane(1.05 * std::tan(angle), 1e-6, {1, 2, 0.1});
  auto& set = rigid_bodies(loop);
  set.gravity = gravity_on_slope(angle);
  const auto block = set.handle(1);
  const Vec3 start = set.position(block);
  for (int n = 0; n < 100; ++n) loop.step(h);
  // Each of the first steps leaves at most 1e-6 of h g; they are taken back by the next ones, not added up.
  REQUIRE((set.position(block) - start).norm() <= 1e-7);
  const Vec3 settled = set.position(block);
  int moved = 0;
  for (int n = 100; n < 60000; ++n) {
    loop.step(h);
    moved += set.position(block) != settled;
  }
  REQUIRE(moved == 0);
  // Contacts are 0.5 m and more from the middle, and 1e-7 m of theirs is twice as much as half the angle.
  REQUIRE(set.orientation(block).vec().norm() <= 1e-7);
}

TEST_CASE("below the tangent a block accelerates with g (sin a - mu cos a)") {
  const double angle = M_PI / 6, mu = 0.3;
  auto loop = block_on_plane(mu, 1e-10);
  auto& set = rigid_bodies(loop);
  set.gravity = gravity_on_slope(angle);
  const auto block = set.handle(1);
  for (int n = 1; n <= 120; ++n) {
    loop.step(h);
    // Constant force: symplectic Euler has v = n h a exactly; the solver leaves 1e-10 a step.
    REQUIRE(set.velocity(block).x() == Approx(n * h * 2.3562872366624).epsilon(1e-8));
  }
}

// μ* (1 ± 1e-6): a net force of 1e-6 g cos a against the friction. The solver must be tighter than that share: 1e-10.
TEST_CASE("the threshold of sliding is the tangent to one part in a million") {
  const double angle = M_PI / 6;
  const auto way = [&](double share) {
    auto loop = block_on_plane(std::tan(angle) * (1 + share), 1e-11);
    auto& set = rigid_bodies(loop);
    set.gravity = gravity_on_slope(angle);
    const auto block = set.handle(1);
    for (int n = 0; n < 600; ++n) loop.step(h);
    return set.position(block).x();
  };
  REQUIRE(std::abs(way(1e-6)) < 1e-8);  // the first steps, then nothing
  // ½ a t² with a = 1e-6 μ g cos a over ten seconds, 2.4e-4 m; a step more or less is 0.2 %.
  REQUIRE(way(-1e-6) == Approx(0.5 * 1e-6 * g * std::sin(angle) * 100).epsilon(0.01));
}

TEST_CASE("the way a block slides does not depend on its heading, runs straight and never lifts") {
  const double v0 = 3, mu = 0.4;
  double shortest = 1e300, longest = 0;
  for (int degrees = 0; degrees <= 45; degrees += 5) {
    const double a = degrees * M_PI / 180;
    const Vec3 ahead(std::cos(a), std::sin(a), 0), aside(-std::sin(a), std::cos(a), 0);
    auto loop = block_on_plane(mu, 1e-9);
    auto& set = rigid_bodies(loop);
    const auto block = set.handle(1);
    set.set_velocity(block, v0 * ahead);
    double lift = 0;
    for (int n = 0; n < 80; ++n) {
      loop.step(h);
      lift = std::max(lift, set.position(block).z() - 0.1);
      REQUIRE(std::abs(set.position(block).dot(aside)) <= 1e-7);
    }
    CAPTURE(degrees);
    REQUIRE(lift <= 1e-8);
    const double way = set.position(block).dot(ahead);
    shortest = std::min(shortest, way);
    longest = std::max(longest, way);
  }
  REQUIRE(longest - shortest <= 1e-6 * longest);
}

}  // namespace sliding_tests
