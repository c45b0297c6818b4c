// The generalised-α method: its order, its damping, and that it goes on from a checkpoint.
#include <delassus/fem/elasticity/linear.hpp>
#include <delassus/fem/tetrahedral_fem.hpp>
#include <delassus/geometry/box_mesh.hpp>
#include <delassus/io/checkpoint.hpp>
#include <delassus/steppers/generalized_alpha.hpp>

#include "catch.hpp"
#include "convergence_order.hpp"
#include "integrators/oscillator.hpp"

#include <limits>

namespace generalized_alpha_tests {

using namespace delassus;

TEST_CASE("an oscillator is met by the generalised-alpha method with second order, whatever its damping") {
  for (const double rho : {0.0, 0.5, 1.0}) {
    const auto orders = convergence_orders(
        [&](double h) {
          auto [loop, mass] = oscillator::make(GeneralizedAlpha{.spectral_radius = rho}, oscillator::omega);
          for (long n = std::lround(1.6 / h); n > 0; --n) loop.step(h);
          return std::abs(bodies<Particles>(loop.world()).position(mass).x() -
                          std::cos(1.6 * oscillator::omega));
        },
        0.01);
    CAPTURE(rho, orders[0], orders[1]);
    CHECK(are_of_order(orders, 2));
  }
}

namespace {

/// Two points on damped springs with a rest length, pulled round: the force is not linear.
Vec3 swung(double h) {
  AnimationLoop loop{World{Particles{}}, GeneralizedAlpha{.spectral_radius = 0.6}};
  auto& set = bodies<Particles>(loop.world());
  const auto first = set.add({.position = {1, 0, 0}, .mass = 1.0}),
             second = set.add({.position = {1.5, 0, 0.5}, .mass = 0.5});
  set.add_spring(first, Vec3::Zero(), 80, 0.5, 0.9);
  set.add_spring(first, second, 60, 1, 0.6);
  for (long n = std::lround(1 / h); n > 0; --n) loop.step(h);
  return set.position(second);
}

}  // namespace

TEST_CASE("springs that turn and are damped are met by the generalised-alpha method with second order") {
  const Vec3 fine = swung(1.0 / 12800);
  const auto orders = convergence_orders([&](double h) { return (swung(h) - fine).norm(); }, 1.0 / 100);
  CAPTURE(orders[0], orders[1]);
  CHECK(are_of_order(orders, 2));
}

// The roots of the method for h ω → ∞ are all −ρ∞, a double one among them: n steps shrink by n ρ∞ⁿ or so.
TEST_CASE("what the step cannot resolve shrinks by the spectral radius") {
  for (const double rho : {0.3, 0.7}) {
    auto [loop, mass] = oscillator::make(GeneralizedAlpha{.spectral_radius = rho}, 1e4);
    auto& set = bodies<Particles>(loop.world());
    double at[2];
    for (int n = 0; n < 60; ++n) {
      loop.step(1.0);
      if (n == 29) at[0] = std::hypot(set.position(mass).x(), set.velocity(mass).x());
      if (n == 59) at[1] = std::hypot(set.position(mass).x(), set.velocity(mass).x());
    }
    CAPTURE(rho, at[0], at[1]);
    CHECK(at[1] <= 4 * std::pow(rho, 30) * at[0] + 1e-12);
    CHECK(at[1] >= 0.5 * std::pow(rho, 30) * at[0] - 1e-12);
  }
}

// A bar of 1 × 0.1 × 0.1 m fixed at one end and drawn out along itself: the wave of c = √(E/ρ) at ν = 0 has
// the period 4 L/c, and ten cells along it are off by (π/40)²/24 of that.
TEST_CASE("a soft bar rings with its own period and keeps its energy at a spectral radius of one") {
  using Soft = TetrahedralFem<Linear>;
  AnimationLoop loop{World{Soft{}}, GeneralizedAlpha{.spectral_radius = 1}};
  auto& soft = bodies<Soft>(loop.world());
  soft.gravity.setZero();
  const auto bar = soft.add({.mesh = box_mesh({1, 0.1, 0.1}, {10, 1, 1}),
                             .elasticity = {.young = 1e5, .poisson = 0},
                             .density = 1000});
  soft.fix(bar, [](const Vec3& x) { return x.x() < 1e-9; });
  for (const Index b : soft.active()) {
    const Vec3 x = soft.pose(b).position;
    soft.velocity()[b] = 0.01 * std::sin(0.5 * EIGEN_PI * x.x()) * Vec3(1, 0, 0);
    if (!soft.moves(b)) soft.velocity()[b].setZero();
  }
  const double period = 4 / std::sqrt(1e5 / 1000), h = period / 200;
  const auto speed = [&] {
    double sum = 0;
    for (const Index b : soft.active()) sum += soft.velocity()[b].x();
    return sum;
  };
  const double start = speed();
  double zero = 0, last = start;
  for (int n = 1; n <= 200; ++n) {
    REQUIRE(loop.step(h).status <= Status::stalled);
    const double now = speed();
    if (zero == 0 && now < 0) zero = h * (n - now / (now - last));
    last = now;
  }
  CHECK(zero == Approx(period / 4).epsilon(0.01));
  CHECK(last == Approx(start).epsilon(0.01));
}

TEST_CASE("a checkpoint of the generalised-alpha method goes on to the bit, and NaN stays where it is") {
  auto [loop, mass] = oscillator::make(GeneralizedAlpha{}, oscillator::omega);
  for (int n = 0; n < 20; ++n) loop.step(0.01);
  const auto kept = checkpoint(loop);
  for (int n = 0; n < 20; ++n) loop.step(0.01);
  const Vec3 there = bodies<Particles>(loop.world()).position(mass);
  restore(loop, kept);
  for (int n = 0; n < 20; ++n) loop.step(0.01);
  auto& set = bodies<Particles>(loop.world());
  CHECK(set.pose(0).position == there);
  set.apply_force(set.handle(0), {std::numeric_limits<double>::quiet_NaN(), 0, 0});
  CHECK(loop.step(0.01).status == Status::quarantined);
  CHECK(set.pose(0).position == there);
  CHECK(loop.step(0.01).status == Status::converged);
}

TEST_CASE("a body that is placed anew and stopped begins without its old acceleration") {
  for (const double radius : {0.0, 0.8, 1.0}) {
    AnimationLoop loop{World{Particles{}}, GeneralizedAlpha{.spectral_radius = radius}};
    auto& set = bodies<Particles>(loop.world());
    set.gravity.setZero();
    const auto mass = set.add({.position = {1.1, 0, 0}, .mass = 1.0});
    set.add_spring(mass, Vec3::Zero(), 1e6, 0, 1.0);
    loop.step(0.01);
    loop.step(0.01);
    set.place(mass, {1, 0, 0});
    set.set_velocity(mass, {0, 0, 0});
    for (int n = 0; n < 50; ++n) {
      loop.step(0.01);
      REQUIRE((set.position(mass) - Vec3(1, 0, 0)).norm() < 1e-12);
    }
  }
}

}  // namespace generalized_alpha_tests
