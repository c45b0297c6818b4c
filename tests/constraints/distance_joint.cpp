#include <delassus/constraints/joints/distance_joint.hpp>

#include <delassus/delassus.hpp>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <type_traits>
#include <utility>
#include <vector>

#include "catch.hpp"

namespace distance_joint_tests {

using namespace delassus;

namespace {

/// A particle on a rod of 1 m without mass, released from the horizontal: IFToMM's benchmark A01.
template <class Integrator, class S>
struct Pendulum {
  AnimationLoop<World<Particles>, Constraints<DistanceJoint>, Integrator, S, GaussSeidel> loop;
  Particles::Handle bob{};
  double energy = 0;

  explicit Pendulum(S stabilisation)
      : loop(World{Particles{}}, Constraints{DistanceJoint{}}, Integrator{}, stabilisation,
             GaussSeidel{.tolerance = 1e-14}) {
    bob = set().add({.position = {1, 0, 0}, .mass = 1.0});
    loop.add(DistanceJoint::Item{anchor(set(), bob), world_anchor(Vec3::Zero()), 1.0});
  }
  Particles& set() { return bodies<Particles>(loop.world()); }
  /// Distance to the reference after `seconds`, and the largest |length − 1| and |ΔE| on the way.
  struct Run {
    double error, drift, energy;
  };
  Run run(double seconds, int steps, const Vec3& reference) {
    Run out{0, 0, 0};
    for (int n = 0; n < steps; ++n) {
      loop.step(seconds / steps);
      out.drift = std::max(out.drift, std::abs(set().position(bob).norm() - 1));
      out.energy = std::max(out.energy, std::abs(kinetic_energy(set()) + potential_energy(set())));
    }
    out.error = (set().position(bob) - reference).norm();
    return out;
  }
};

const Vec3 after_1s(-0.986291751131875, 0, -0.165010853125541);
const Vec3 after_10s(0.275087462576117, 0, -0.961419205099125);

}  // namespace

// The constants are those of independent implementations of the same scheme, with half as much again.
TEST_CASE("the pendulum of benchmark A01 errs, drifts and gains as its scheme must, after 10 s at h = 0.01") {
  const auto run = Pendulum<SymplecticEuler, Baumgarte>({.rate = 0.2}).run(10, 1000, after_10s);
  CHECK(run.error <= 1.5 * 2.3e-2);
  CHECK(run.drift <= 1.5 * 4.8e-3);
  CHECK(run.energy <= 1.5 * 0.36);
  CHECK((Pendulum<ImplicitMidpoint, WholeViolation>({}).run(10, 1000, after_10s).error <= 1.5 * 4.8e-3));
}

TEST_CASE("the pendulum is met with order 1 by symplectic Euler, order 2 by the midpoint rule") {
  const auto order = []<class P>(std::type_identity<P>, double seconds, int steps, const Vec3& reference) {
    const double coarse = P({}).run(seconds, steps, reference).error;
    return std::log2(coarse / P({}).run(seconds, 2 * steps, reference).error);
  };
  for (const int factor : {2, 4}) {
    // Over one swing for the first, whose energy error cancels in the mean of several.
    const double first = order(std::type_identity<Pendulum<SymplecticEuler, WholeViolation>>{}, 1, 100 * factor, after_1s);
    const double second = order(std::type_identity<Pendulum<ImplicitMidpoint, WholeViolation>>{}, 10, 1000 * factor, after_10s);
    CAPTURE(factor, first, second);
    CHECK((first >= 0.85 && first <= 1.5));
    CHECK((second >= 1.85 && second <= 2.5));
  }
}

// T/T0 by the complete elliptic integral; the crossing of the vertical is found between two steps. The
// midpoint rule's phase error is of order (h ω)², here (1e-3 · 3.13)² ~ 1e-5.
TEST_CASE("a swing of 90 degrees takes 1.18034 small swings") {
  Pendulum<ImplicitMidpoint, WholeViolation> pendulum({});
  const double h = 1e-3, expected = 1.1803405990161 * 2 * std::numbers::pi * std::sqrt(1 / 9.81);
  std::vector<double> crossings;
  double last = 1;
  for (int n = 1; crossings.size() < 3; ++n) {
    pendulum.loop.step(h);
    const double x = pendulum.set().position(pendulum.bob).x();
    if (x * last < 0) crossings.push_back(h * (n - x / (x - last)));
    last = x;
  }
  CHECK(crossings[2] - crossings[0] == Approx(expected).epsilon(1e-5));
}

// At the lowest point the rod carries 3 m g. λ is the mean over the step; first order in h on a smooth
// function.
TEST_CASE("the rod of a pendulum carries three times the weight at the lowest point") {
  AnimationLoop loop{World{Particles{}}, Constraints{DistanceJoint{}}, ImplicitMidpoint{}, WholeViolation{}};
  auto& set = bodies<Particles>(loop.world());
  const auto bob = set.add({.position = {1, 0, 0}, .mass = 2.0});
  const auto rod = loop.add(DistanceJoint::Item{anchor(set, bob), world_anchor(Vec3::Zero()), 1.0});
  const double h = 1e-4;
  double largest = 0;
  for (int n = 0; n < 7000; ++n) {
    loop.step(h);
    largest = std::max(largest, std::abs(loop.impulse(rod)[0]) / h);
  }
  CHECK(largest == Approx(3 * 2 * 9.81).epsilon(1e-4));
}

// m (v⁺ − v) = −h (k (φ + h v⁺) + c v⁺) along the line; one row, solved exactly at one visit. 500 roundings
// of 1.4.
TEST_CASE("a soft distance joint is implicit Euler's spring and damper in closed form") {
  const double h = 0.02, k = 150, c = 3, m = 2;
  AnimationLoop loop{World{Particles{}}, Constraints{DistanceJoint{}}};
  auto& set = bodies<Particles>(loop.world());
  set.gravity.setZero();
  const auto bob = set.add({.position = {1.4, 0, 0}, .mass = m});
  loop.add(DistanceJoint::Item{anchor(set, bob), world_anchor(Vec3::Zero()), 1.0, k, c});
  double phi = 0.4, v = 0;
  for (int n = 0; n < 500; ++n) {
    v = (m * v - h * k * phi) / (m + h * h * k + h * c);
    phi += h * v;
    const StepReport report = loop.step(h);
    REQUIRE(report.status == Status::converged);
    REQUIRE(std::abs(set.position(bob).x() - 1 - phi) <= 1e-13);
  }
}

TEST_CASE("a soft distance joint and a spring of the particles move two particles alike") {
  const double h = 0.02, k = 150, c = 3;
  AnimationLoop joined{World{Particles{}}, Constraints{DistanceJoint{}}, ImplicitEuler{}};
  AnimationLoop sprung{World{Particles{}}, ImplicitEuler{}};
  std::vector<Particles::Handle> at;
  for (auto* set : {&bodies<Particles>(joined.world()), &bodies<Particles>(sprung.world())}) {
    set->gravity.setZero();
    at.push_back(set->add({.position = {1.4, 0, 0}, .velocity = {0.3, 0, 0}, .mass = 2.0}));
    at.push_back(set->add({.position = {0, 0, 0}, .mass = 0.5}));
  }
  auto& a = bodies<Particles>(joined.world());
  auto& b = bodies<Particles>(sprung.world());
  joined.add(DistanceJoint::Item{anchor(a, at[0]), anchor(a, at[1]), 1.0, k, c});
  b.add_spring(at[2], at[3], k, c, 1.0);
  for (int n = 0; n < 500; ++n) {
    joined.step(h);
    sprung.step(h);
    // Along one line both are the same equations; 500 steps of a few roundings of 3 m.
    REQUIRE((a.position(at[0]) - b.position(at[2])).norm() <= 1e-12);
    REQUIRE((a.position(at[1]) - b.position(at[3])).norm() <= 1e-12);
  }
}

// The rows hold along the direction guessed for the middle of the step: what is left is of the order the rule
// has, at least.
TEST_CASE("a chain of particles keeps its lengths to the square of the step") {
  std::vector<double> worst;
  for (const double h : {1e-2, 5e-3, 2.5e-3}) {
    AnimationLoop loop{World{Particles{}}, Constraints{DistanceJoint{}}, ImplicitMidpoint{}, WholeViolation{},
                       AcceleratedGaussSeidel{.tolerance = 1e-10}};
    auto& set = bodies<Particles>(loop.world());
    Anchor last = world_anchor(Vec3::Zero());
    for (int i = 1; i <= 5; ++i) {
      const auto bead = set.add({.position = {0.2 * i, 0, 0}, .mass = 0.2});
      loop.add(DistanceJoint::Item{last, anchor(set, bead), 0.2});
      last = anchor(set, bead);
    }
    worst.push_back(0);
    // Until the chain hangs; later the whip of its end is not smooth on this grid.
    for (int n = 0; n < int(0.4 / h); ++n)
      worst.back() = std::max(worst.back(), loop.step(h).max_joint_violation);
  }
  CAPTURE(worst[0], worst[1], worst[2]);
  CHECK(std::log2(worst[0] / worst[1]) >= 1.85);
  CHECK(std::log2(worst[1] / worst[2]) >= 1.85);
}

}  // namespace distance_joint_tests
