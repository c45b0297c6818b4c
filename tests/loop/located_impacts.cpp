// Impacts at the time at which they happen.
#include <delassus/bodies/invariants.hpp>
#include <delassus/loop/located_impacts.hpp>
#include <delassus/loop/newton_midpoint.hpp>
#include <delassus/loop/rattle.hpp>
#include <delassus/loop/runge_kutta4.hpp>

#include "convergence_order.hpp"
#include "loop/smooth_scenes.hpp"
#include "scenes.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <vector>

#include "catch.hpp"

namespace located_impacts_tests {

using namespace scenes;

namespace {

constexpr double radius = 0.1;

/// A wall whose outside is where x is above 0, for balls of `radius` about x = 0.
void add_wall(RigidBodies& set) {
  set.add({.position = {-radius, 0, 0},
           .orientation = Quat::FromTwoVectors(Vec3::UnitZ(), Vec3::UnitX()),
           .shape = HalfSpace{},
           .motion = Motion::fixed});
}

/// The pendulum of AC-08, whose bob meets a wall at the lowest point and leaves it with 0.8 of its speed.
template <class Integrator>
double error_at_a_wall(Integrator integrator, double h) {
  AnimationLoop loop{World{RigidBodies{}},
                     Constraints{DistanceJoint{}, Contact{Restitution{Frictionless{}, 0.8}}}, integrator,
                     LocatedImpacts{}, AcceleratedGaussSeidel{.tolerance = 1e-13}};
  auto& set = rigid_bodies(loop);
  const auto bob = set.add({.position = {1, 0, 0}, .mass = 1.0, .shape = Sphere{radius}});
  add_wall(set);
  loop.add(DistanceJoint::Item{.a = anchor(set, bob), .b = world_anchor({0, 0, 0}), .length = 1});
  Index met = 0;
  for (long n = std::lround(1 / h); n > 0; --n) met += loop.step(h).contacts;
  REQUIRE(met == 1);
  // It is there after a quarter of AC-08's period, and leaves with sin(θ/2) = k sn(√g τ), k = 0.8 sin 45°.
  const double k = 0.8 * std::sqrt(0.5), there = 2.36784194757624 / 4;
  const double half = k * smooth::jacobi(std::sqrt(9.81) * (1 - there), k)[0];
  const Vec3 end(2 * half * std::sqrt(1 - half * half), 0, 2 * half * half - 1);
  return (set.position(bob) - end).norm();
}

/// A particle on a spring that meets a wall where the spring is slack, e = 0.8: after 1.1 s.
double oscillator_error(double h) {
  AnimationLoop loop{World{RigidBodies{}, Particles{}},
                     Constraints{Contact{Restitution{Frictionless{}, 0.8}}}, ImplicitMidpoint{},
                     LocatedImpacts{}};
  add_wall(rigid_bodies(loop));
  auto& set = bodies<Particles>(loop.world());
  set.gravity.setZero();
  const double omega = 2 * std::numbers::pi;
  const auto mass = set.add({.position = {1, 0, 0}, .mass = 1.0, .radius = radius});
  set.add_spring(mass, Vec3::Zero(), omega * omega, 0, 0.0);
  Index met = 0;
  for (long n = std::lround(1.1 / h); n > 0; --n) met += loop.step(h).contacts;
  REQUIRE(met == 2);  // at 1/4 and 3/4 of a period, to 0.8² of the way
  return std::abs(set.position(mass).x() - 0.64 * std::sin(omega * 0.35));
}

/// A ball of 1 kg over a plane, without friction, at a height (m) of its lowest point.
template <class... Policies>
auto falling(double restitution, double height, Policies... policies) {
  AnimationLoop loop{World{RigidBodies{}}, Constraints{Contact{Restitution{Frictionless{}, restitution}}},
                     LocatedImpacts{}, policies...};
  auto& set = rigid_bodies(loop);
  set.add_fixed(HalfSpace{});
  set.add({.position = {0, 0, height + radius}, .mass = 1.0, .shape = Sphere{radius}});
  return loop;
}

}  // namespace

TEST_CASE("a pendulum that meets a wall keeps the order of its integrator") {
  CHECK(are_of_order(convergence_orders([](double h) { return error_at_a_wall(Rattle{}, h); }, 1.0 / 32), 2));
  CHECK(are_of_order(
      convergence_orders([](double h) { return error_at_a_wall(NewtonMidpoint{}, h); }, 1.0 / 32), 2));
  CHECK(are_of_order(convergence_orders([](double h) { return error_at_a_wall(RungeKutta4{}, h); }, 1.0 / 32),
                     4));
}

TEST_CASE("an oscillator that meets a wall twice keeps the order of the midpoint rule") {
  CHECK(are_of_order(convergence_orders(oscillator_error, 1.1 / 40), 2));
}

// The parabola is exact under the midpoint rule and under Runge-Kutta. A bounce is off by the gap's tolerance
// and roundings of z and v: a few 1e-16 of each, a hundred times.
TEST_CASE("a ball with restitution 1 bounces a hundred times and keeps its energy to rounding") {
  const auto check = [](auto loop) {
    auto& set = rigid_bodies(loop);
    const auto ball = set.handle(1);
    Index bounces = 0;
    for (int n = 0; n < 4000 && bounces < 100; ++n) bounces += loop.step(0.031).contacts;
    REQUIRE(bounces >= 100);
    const double v = set.velocity(ball).z();
    CHECK(0.5 * v * v + 9.81 * (set.position(ball).z() - radius) == Approx(9.81).epsilon(2e-12));
  };
  check(falling(1, 1, ImplicitMidpoint{}));
  check(falling(1, 1, RungeKutta4{}));
}

// AC-24: with e = 1/2 from 1 m, rest after 1.3546 s. Nothing happens twice within a 64th of a step, so what
// is left is a ball at rest under an ordinary step.
TEST_CASE("a ball that bounces ever less comes to rest in time and stays") {
  const auto check = [](auto loop) {
    auto& set = rigid_bodies(loop);
    const auto ball = set.handle(1);
    while (loop.time() < 1.35457092295719 + 0.01) REQUIRE(loop.step(0.01).status == Status::converged);
    CHECK(set.velocity(ball).norm() <= 9.81 * 0.01);
    for (int n = 0; n < 100; ++n) REQUIRE(loop.step(0.01).status == Status::converged);
    CHECK(set.velocity(ball).norm() <= 1e-12);
    CHECK(std::abs(set.position(ball).z() - radius) <= 1e-4);
    REQUIRE(loop.contacts().size() == 1);
    CHECK(loop.contacts()[0].impulse.norm() == Approx(9.81 * 0.01).epsilon(1e-9));
  };
  check(falling(0.5, 1, ImplicitMidpoint{}));
  check(falling(0.5, 1));
  check(falling(0.5, 1, RungeKutta4{}));
}

TEST_CASE("balls a hair apart are hit in turn, however long the step") {
  AnimationLoop loop{World{RigidBodies{}}, Constraints{Contact{Restitution{Coulomb{.friction = 0.3}, 1.0}}},
                     LocatedImpacts{}, AcceleratedGaussSeidel{.tolerance = 1e-13}};
  auto& set = rigid_bodies(loop);
  set.gravity.setZero();
  std::vector<RigidBodies::Handle> balls;
  for (int i = 0; i < 5; ++i)
    balls.push_back(
        set.add({.position = {i * (2 * radius + 1e-6), 0, 0}, .mass = 1.0, .shape = Sphere{radius}}));
  set.set_velocity(balls[0], {1, 0, 0});
  loop.step(0.1);
  for (int i = 0; i < 5; ++i) CHECK(set.velocity(balls[i]).x() == Approx(i == 4 ? 1 : 0).margin(1e-10));
  REQUIRE(loop.contacts().size() == 4);
  for (const auto& contact : loop.contacts()) CHECK(contact.impulse.norm() == Approx(1).epsilon(1e-10));
}

// λ of the wall and, within the same step, of the joint: the sum is the change of the momentum.
TEST_CASE("impulses of a step are the sums of its flights and impacts") {
  AnimationLoop loop{World{RigidBodies{}},
                     Constraints{BallJoint{}, Contact{Restitution{Frictionless{}, 0.5}}}, NewtonMidpoint{},
                     LocatedImpacts{}, AcceleratedGaussSeidel{.tolerance = 1e-13}};
  auto& set = rigid_bodies(loop);
  const auto rod = set.add({.position = {0.5, 0, 0}, .mass = 1.0, .shape = Box{1, 0.1, 0.1}});
  set.add_fixed(HalfSpace{}, {0, 0, -0.3});
  const auto pivot =
      loop.add(BallJoint::Item{.a = anchor_at(set, rod, {0, 0, 0}), .b = world_anchor({0, 0, 0})});
  bool is_met = false;
  for (int n = 0; n < 20; ++n) {
    const Vec3 before = set.velocity(rod);
    loop.step(0.02);
    Vec3 given = loop.impulse(pivot) + Vec3(0, 0, -9.81 * 0.02);
    for (const auto& contact : loop.contacts()) {
      const bool is_second = contact.record.b.block == 0;
      given += is_second ? contact.impulse : Vec3(-contact.impulse);
      is_met = is_met || contact.impulse.norm() > 0.1;
    }
    CHECK((set.velocity(rod) - before - given).norm() <= 1e-9);
  }
  CHECK(is_met);
}

TEST_CASE("a load acts over the whole of a step with an impact, and a kinematic body arrives at its end") {
  auto loop = falling(1, 0.01, ImplicitMidpoint{});
  auto& set = rigid_bodies(loop);
  const auto ball = set.handle(1);
  set.gravity.setZero();
  set.set_velocity(ball, {0, 0, -1});
  set.apply_force(ball, {4, 0, 0});
  const auto led = set.add({.motion = Motion::kinematic});
  set.move_to(led, {1, 2, 3});
  REQUIRE(loop.step(0.1).contacts == 1);
  CHECK(set.velocity(ball).x() == Approx(0.4).epsilon(1e-12));
  CHECK(set.position(ball).x() == Approx(0.02).epsilon(1e-12));
  CHECK(set.position(ball).z() == Approx(radius + 0.09).epsilon(1e-12));
  CHECK(set.position(led) == Vec3(1, 2, 3));
  CHECK(loop.time() == 0.1);
}

TEST_CASE("located impacts are the same bits in every run") {
  const auto run = [] {
    auto loop = falling(0.7, 0.5, Rattle{});
    auto& set = rigid_bodies(loop);
    const auto other = set.add({.position = {0.05, 0, 1.5},
                                .angular_velocity = {1, 2, 3},
                                .mass = 2.0,
                                .shape = Box{0.3, 0.2, 0.1}});
    for (int n = 0; n < 200; ++n) loop.step(0.01);
    return std::pair{set.position(set.handle(1)), set.position(other)};
  };
  const auto first = run(), second = run();
  CHECK(first.first == second.first);
  CHECK(first.second == second.second);
  CHECK(first.second.allFinite());
}

TEST_CASE("a force that is no number holds its body, and the others go on between their impacts") {
  auto loop = falling(1, 0.5, ImplicitMidpoint{});
  auto& set = rigid_bodies(loop);
  const auto sick = set.add({.position = {5, 0, 1}, .mass = 1.0, .shape = Sphere{radius}});
  for (int n = 0; n < 100; ++n) {
    set.apply_force(sick, {std::numeric_limits<double>::quiet_NaN(), 0, 0});
    const StepReport report = loop.step(0.02);
    REQUIRE(report.status == Status::quarantined);
    REQUIRE(report.quarantined == 1);
  }
  CHECK(set.position(sick) == Vec3(5, 0, 1));
  const auto ball = set.handle(1);
  const double v = set.velocity(ball).z();
  CHECK(0.5 * v * v + 9.81 * (set.position(ball).z() - radius) == Approx(0.5 * 9.81).epsilon(1e-11));
}

TEST_CASE("numbers of located impacts are refused by name") {
  auto refuse = [](LocatedImpacts scheme) {
    AnimationLoop loop{World{RigidBodies{}}, Constraints{Contact{Frictionless{}}}, scheme};
    loop.step(0.01);
  };
  CHECK_THROWS_WITH(refuse({.tolerance = 0}), Catch::Contains("LocatedImpacts: tolerance 0 m must be > 0"));
  CHECK_THROWS_WITH(refuse({.max_impacts = 0}),
                    Catch::Contains("LocatedImpacts: max_impacts 0 must be >= 1"));
}

// z = h u − g h²/2 from the floor, at u = 5 m/s, and no step of less.
TEST_CASE("a ball that touches at the start of a step and closes is hit there") {
  for (const double gap : {0.0, 5e-13, -5e-13}) {
    auto loop = falling(1, gap, ImplicitMidpoint{});
    auto& set = rigid_bodies(loop);
    const auto ball = set.handle(1);
    set.set_velocity(ball, {0, 0, -5});
    const double h = 0.02;
    REQUIRE(loop.step(h).contacts == 1);
    CHECK(set.velocity(ball).z() == Approx(5 - 9.81 * h).epsilon(1e-12));
    CHECK(set.position(ball).z() - radius == Approx(5 * h - 9.81 * h * h / 2).epsilon(1e-10));
  }
}

// Baumgarte closes a fifth of 1 mm in a step of 10 ms: 0.02 m/s, less what earlier parts of the step have
// closed.
TEST_CASE("an open joint closes at the pace of the step, however short a flight is") {
  for (const double before_end : {1e-3, 1e-4, 1e-6}) {
    AnimationLoop loop{World{RigidBodies{}, Particles{}},
                       Constraints{BallJoint{}, Contact{Restitution{Frictionless{}, 0.5}}}, LocatedImpacts{}};
    auto& set = rigid_bodies(loop);
    auto& particles = bodies<Particles>(loop.world());
    set.gravity.setZero(), particles.gravity.setZero();
    set.add_fixed(HalfSpace{});
    const auto held = set.add({.position = {0, 0, 5}, .mass = 1.0, .shape = Sphere{radius}});
    loop.add(BallJoint::Item{.a = anchor(set, held), .b = world_anchor({1e-3, 0, 5})});
    particles.add({.position = {100, 0, radius + 0.01 - before_end},
                   .velocity = {0, 0, -1},
                   .mass = 1.0,
                   .radius = radius});
    REQUIRE(loop.step(0.01).contacts == 1);
    CHECK(set.velocity(held).norm() <= 0.02 * (1 + 1e-9));
    CHECK(set.velocity(held).norm() >= 0.015);
  }
}

namespace {

/// The most energy (J) that a chain of four boxes has on its way down to a floor and on it, of what it begins
/// with.
template <class Integrator>
double most_energy_of_chain(Integrator integrator, double lean) {
  AnimationLoop loop{World{RigidBodies{}},
                     Constraints{BallJoint{}, Contact{Restitution{Coulomb{.friction = 0.3}, 0.5}}},
                     integrator, LocatedImpacts{}};
  auto& set = rigid_bodies(loop);
  set.add_fixed(HalfSpace{});
  const Quat turn(Eigen::AngleAxisd(lean, Vec3(1, 2, -1).normalized()));
  const Vec3 root(0, 0, 1.5 + lean), link = turn * Vec3(0.5, 0, 0);
  std::vector<RigidBodies::Handle> boxes;
  for (int i = 0; i < 4; ++i)
    boxes.push_back(set.add({.position = root + i * link,
                             .orientation = turn,
                             .velocity = {0, 0, -1},
                             .mass = 1.0,
                             .shape = Box{0.4, 0.1, 0.1}}));
  for (int i = 0; i < 3; ++i) {
    const Vec3 joint = root + (i + 0.5) * link;
    loop.add(BallJoint::Item{.a = anchor_at(set, boxes[i], joint), .b = anchor_at(set, boxes[i + 1], joint)});
  }
  const auto energy = [&] { return kinetic_energy(set) + potential_energy(set); };
  const double start = energy();
  double most = start;
  for (int n = 0; n < 200; ++n) {
    REQUIRE(loop.step(0.01).quarantined == 0);
    most = std::max(most, energy());
  }
  return most / start;
}

}  // namespace

// Steps with contacts leave joints open, which a flight between two impacts must not close at once.
TEMPLATE_TEST_CASE("a chain that falls on a floor gains no energy by impacts", "", SymplecticEuler, Rattle,
                   NewtonMidpoint, RungeKutta4) {
  for (const double lean : {0.2, 0.9, 1.6, 2.3}) CHECK(most_energy_of_chain(TestType{}, lean) <= 1.01);
}

}  // namespace located_impacts_tests
