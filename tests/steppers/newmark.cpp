// Newmark's method and the second backward differentiation formula: closed forms of one oscillator, and soft
// bodies.
#include <delassus/fem/elasticity/linear.hpp>
#include <delassus/fem/tetrahedral_fem.hpp>
#include <delassus/geometry/box_mesh.hpp>
#include <delassus/io/checkpoint.hpp>
#include <delassus/steppers/bdf2.hpp>
#include <delassus/steppers/newmark.hpp>

#include "catch.hpp"
#include "convergence_order.hpp"
#include "integrators/oscillator.hpp"

#include <array>
#include <cmath>
#include <complex>
#include <vector>

using namespace delassus;

namespace {

/// x and v/ω of an oscillator after each step.
template <class I>
std::vector<std::array<double, 2>> path_of_oscillator(const I& integrator, double rate, double h, int steps) {
  auto [loop, mass] = oscillator::make(integrator, rate);
  auto& set = bodies<Particles>(loop.world());
  std::vector<std::array<double, 2>> path;
  for (int n = 0; n < steps; ++n) {
    loop.step(h);
    path.push_back({set.position(mass).x(), set.velocity(mass).x() / rate});
  }
  return path;
}

/// Two points on damped springs with a rest length, pulled round: the force is not linear. For a second, the
/// step halved after half of it if asked.
Vec3 swung_points(double h, bool is_halved = false) {
  AnimationLoop loop{World{Particles{}}, Bdf2{}};
  auto& set = bodies<Particles>(loop.world());
  const auto first = set.add({.position = {1, 0, 0}, .mass = 1.0}),
             second = set.add({.position = {1.5, 0, 0.5}, .mass = 0.5});
  set.add_spring(first, Vec3::Zero(), 80, 0.5, 0.9);
  set.add_spring(first, second, 60, 1, 0.6);
  const long half = std::lround(0.5 / h);
  for (long n = 0; n < half; ++n) loop.step(h);
  for (long n = 0; n < (is_halved ? 2 : 1) * half; ++n) loop.step(is_halved ? h / 2 : h);
  return set.position(second);
}

}  // namespace

// The trapezoidal rule turns (x, v/ω) by 2 atan(hω/2), to the rounding of a thousand steps.
TEST_CASE("Newmark's method with a quarter and a half turns an oscillator by the trapezoidal rule") {
  for (const double h : {0.01, 0.3}) {
    const double turn = 2 * std::atan(h * oscillator::omega / 2);
    const auto path = path_of_oscillator(Newmark{}, oscillator::omega, h, 1000);
    for (int n = 1; n <= 1000; n += 111) {
      CAPTURE(h, n);
      CHECK(std::abs(path[n - 1][0] - std::cos(n * turn)) < 1e-10);
      CHECK(std::abs(path[n - 1][1] + std::sin(n * turn)) < 1e-10);
    }
  }
}

// For x' = i ω x the formula's roots solve (3/2 − i ω h) z² − 2 z + ½ = 0; the slower one carries the motion.
TEST_CASE("an oscillator under the second backward formula shrinks a step by the root of its polynomial") {
  const double h = 0.02;
  using Complex = std::complex<double>;
  const Complex a(1.5, -oscillator::omega * h), root = (2. + std::sqrt(4. - 2. * a)) / (2. * a);
  const auto path = path_of_oscillator(Bdf2{}, oscillator::omega, h, 200);
  const auto size = [&](int n) { return std::hypot(path[n][0], path[n][1]); };
  // The other root, 0.35 a step, is gone after forty; Newton's method ends at 1e-10.
  CHECK(size(199) / size(99) == Approx(std::pow(std::abs(root), 100)).epsilon(1e-6));
}

TEST_CASE("what the step cannot resolve is gone after a few steps of the second backward formula") {
  // For hω → ∞ both roots go to 0: each step of hω = 10⁴ leaves some 1/√(hω) of it.
  const auto path = path_of_oscillator(Bdf2{}, 1e4, 1.0, 10);
  CHECK(std::hypot(path.back()[0], path.back()[1]) < 1e-12);
}

TEST_CASE("springs that turn and are damped are met by the second backward formula with second order") {
  const Vec3 fine = swung_points(1.0 / 12800);
  const auto orders =
      convergence_orders([&](double h) { return (swung_points(h) - fine).norm(); }, 1.0 / 200);
  CAPTURE(orders[0], orders[1]);
  CHECK(are_of_order(orders, 2));
  // One change of the step costs no order: what it makes once is of the size of h³.
  const auto halved =
      convergence_orders([&](double h) { return (swung_points(h, true) - fine).norm(); }, 1.0 / 200);
  CAPTURE(halved[0], halved[1]);
  CHECK(are_of_order(halved, 2));
}

// A bar that is drawn out and let go: Newmark's ¼, ½ keeps ½ v M v + ½ u K u. The formula's slower root
// leaves 1 − ½ (hω)⁴ of the energy a step; of the slowest wave along the bar hω = ½ π h √(E/ρ)/L = 0.157, 6 %
// in 200 steps, and 88 % of the energy is along it. γ = 0.6 damps by (γ − ½) hω/2 of the critical, 39 % in
// these steps.
TEST_CASE("a soft bar keeps its energy by Newmark's method, and loses it with more damping by the others") {
  const auto energy_left = [](auto integrator) {
    using Ringing = TetrahedralFem<Linear>;
    AnimationLoop loop{World{Ringing{}}, integrator};
    auto& soft = bodies<Ringing>(loop.world());
    soft.gravity.setZero();
    const auto bar =
        soft.add({.mesh = box_mesh({1, 0.1, 0.1}, {6, 1, 1}), .elasticity = {.young = 1e5, .poisson = 0.3}});
    soft.fix(bar, [](const Vec3& x) { return x.x() < 1e-9; });
    for (const Index b : soft.active())
      if (soft.moves(b)) soft.velocity()[b] = Vec3(0.1, 0.02, -0.03) * soft.pose(b).position.x();
    const auto energy = [&] {
      double sum = soft.elastic_energy();
      for (const Index b : soft.active()) sum += 0.5 * soft.mass(b) * soft.velocity()[b].squaredNorm();
      return sum;
    };
    const double first = energy();
    for (int n = 0; n < 200; ++n) REQUIRE(loop.step(0.01).status <= Status::stalled);
    return energy() / first;
  };
  CHECK(energy_left(Newmark{}) == Approx(1).epsilon(1e-8));  // 200 steps solved to 1e-10
  const double backward = energy_left(Bdf2{}), damped = energy_left(Newmark{.beta = 0.3025, .gamma = 0.6});
  CHECK(backward < 0.95);
  CHECK(damped < 0.95);
}

// What is left of the forces is rounding, and no share of itself is small: the step ends where y moves no place.
TEST_CASE("a soft bar at rest without a load is solved") {
  const auto is_solved = [](const auto& integrator) {
    AnimationLoop loop{World{TetrahedralFem<Linear>{}}, integrator};
    auto& set = bodies<TetrahedralFem<Linear>>(loop.world());
    set.gravity.setZero();
    const Quat lean(Eigen::AngleAxisd(0.3, Vec3(1, 2, 3).normalized()));  // no coordinate is exact
    set.add({.mesh = box_mesh({1, 0.3, 0.3}, {3, 1, 1}), .elasticity = {.young = 1e5}, .density = 1000, .orientation = lean});
    bool is_always = true;
    for (int n = 0; n < 5; ++n) is_always = loop.step(0.01).status == Status::converged && is_always;
    return is_always;
  };
  CHECK(is_solved(Newmark{}));
  CHECK(is_solved(Bdf2{}));
}

TEST_CASE("impossible numbers of Newmark's method are refused") {
  CHECK_THROWS_WITH((AnimationLoop{World{Particles{}}, Newmark{.gamma = 0.4}}),
                    Catch::Contains("Newmark: gamma 0.4 must be in [0.5, 1]"));
  CHECK_THROWS_WITH((AnimationLoop{World{Particles{}}, Newmark{.beta = 0.2}}),
                    Catch::Contains("Newmark: beta 0.2 must be in [gamma/2, 1]"));
  CHECK_THROWS_WITH((AnimationLoop{World{Particles{}}, Bdf2{.max_iterations = 0}}),
                    Catch::Contains("Bdf2: max_iterations 0 must be > 0"));
}

// A step with a force that is no number is not taken; what a checkpoint leaves out would be what memory holds.
TEST_CASE("a point that is placed begins anew, after a bad step and after a checkpoint too") {
  auto [loop, mass] = oscillator::make(Bdf2{}, oscillator::omega);
  auto [hurt, same_mass] = oscillator::make(Bdf2{}, oscillator::omega);
  const auto put = [](auto& each, const auto& point) {
    bodies<Particles>(each.world()).place(point, {2, 0, 0});
    each.step(0.01);
    return bodies<Particles>(each.world()).position(point);
  };
  for (int n = 0; n < 20; ++n) loop.step(0.01), hurt.step(0.01);
  const auto kept = checkpoint(loop);
  bodies<Particles>(hurt.world()).apply_force(same_mass, {std::nan(""), 0, 0});
  CHECK(hurt.step(0.01).status == Status::quarantined);
  const Vec3 anew = put(loop, mass);
  CHECK(put(hurt, same_mass) == anew);
  CHECK(anew.x() < 2);
  auto [again, other_mass] = oscillator::make(Bdf2{}, oscillator::omega);
  restore(again, kept);
  CHECK(put(again, other_mass) == anew);
}
