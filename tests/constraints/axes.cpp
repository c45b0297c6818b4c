// Limits, motors, drives and dry friction on the free axes of joints.
#include <delassus/delassus.hpp>

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>
#include <vector>

#include "catch.hpp"

namespace axes_tests {

using namespace delassus;

namespace {

constexpr double h = 0.01, inertia = 2e-3, mass = 0.7;

/// One body that turns about z (on a hinge) and one that moves along x (on a slider), both without gravity.
struct Axes {
  AnimationLoop<World<RigidBodies>,
                Constraints<Hinge, Slider, Limit<Turn>, Limit<Slide>, Motor<Turn>, Motor<Slide>, Drive<Turn>,
                            Drive<Slide>>,
                AcceleratedGaussSeidel, WholeViolation, MatrixFreeCompliance>
      loop{World{RigidBodies{}},
           {},
           AcceleratedGaussSeidel{.tolerance = 1e-13},
           WholeViolation{},
           MatrixFreeCompliance{}};
  RigidBodies::Handle wheel, cart;
  Anchor ground = world_anchor(Vec3::Zero()), rail = world_anchor({0, 3, 0}, frame_along({1, 0, 0})), axle,
         bearing;

  Axes() {
    set().gravity.setZero();
    wheel = set().add({.mass = mass, .inertia = Mat3(Vec3(1.5e-3, 1e-3, inertia).asDiagonal())});
    cart = set().add({.position = {0, 3, 0}, .mass = mass, .inertia = Mat3(inertia * Mat3::Identity())});
    axle = anchor(set(), wheel);
    bearing = anchor(set(), cart, Vec3::Zero(), frame_along({1, 0, 0}));
    loop.add(Hinge::Item{ground, axle});
    loop.add(Slider::Item{rail, bearing});
  }
  RigidBodies& set() { return bodies<RigidBodies>(loop.world()); }
  double angle() { return 2 * std::atan2(set().orientation(wheel).z(), set().orientation(wheel).w()); }
  double rate() { return set().angular_velocity(wheel).z(); }
  double place() { return set().position(cart).x(); }
  double speed() { return set().velocity(cart).x(); }
  void spin(double w) { set().set_velocity(wheel, Vec3::Zero(), {0, 0, w}); }
  void push(double v) { set().set_velocity(cart, {v, 0, 0}); }
};

}  // namespace

// Stopped within the step at the bound itself: what is left is the solver's tolerance, 1e-13 of the rate,
// over h.
TEST_CASE("a limit stops a hinge and a slider at its bounds and gives no speed back") {
  for (const double sign : {1.0, -1.0}) {
    Axes axes;
    axes.loop.add(Limit<Turn>::Item{.a = axes.ground, .b = axes.axle, .lower = -0.5, .upper = 0.5});
    axes.loop.add(Limit<Slide>::Item{.a = axes.rail, .b = axes.bearing, .lower = -0.25, .upper = 0.25});
    axes.spin(3.3 * sign);
    axes.push(1.7 * sign);
    double widest = 0, farthest = 0;
    for (int n = 0; n < 100; ++n) {
      axes.loop.step(h);
      widest = std::max(widest, sign * axes.angle());
      farthest = std::max(farthest, sign * axes.place());
      CHECK(sign * axes.rate() <= 3.3 + 1e-12);
      CHECK(sign * axes.rate() >= -1e-9);
      CHECK(sign * axes.speed() >= -1e-9);
    }
    // The rotation's step turns by h ω but for (h ω)⁵/120 = 3.3e-10 in the worst step; the solver leaves
    // 1e-10.
    CHECK(std::abs(widest - 0.5) <= 4.3e-10);
    CHECK(std::abs(farthest - 0.25) <= 1e-10);
    CHECK(std::abs(axes.rate()) <= 1e-9);
    CHECK(std::abs(axes.speed()) <= 1e-9);
  }
}

TEST_CASE("a limit with restitution e gives the share e of the speed back") {
  Axes axes;
  axes.loop.add(Limit<Turn>::Item{.a = axes.ground, .b = axes.axle, .upper = 0.5, .restitution = 0.6});
  axes.loop.add(Limit<Slide>::Item{.a = axes.rail, .b = axes.bearing, .lower = -0.25, .restitution = 1});
  axes.spin(3.0);
  axes.push(-2.0);
  for (int n = 0; n < 60; ++n) axes.loop.step(h);
  CHECK(axes.rate() == Approx(-0.6 * 3.0).epsilon(1e-9));
  CHECK(axes.speed() == Approx(2.0).epsilon(1e-9));
}

TEST_CASE("a limit that is far has no row in any island and costs no accuracy") {
  Axes axes;
  const auto limit =
      axes.loop.add(Limit<Turn>::Item{.a = axes.ground, .b = axes.axle, .lower = -3, .upper = 3});
  axes.spin(0.1);
  const StepReport report = axes.loop.step(h);
  CHECK(report.residual <= 1e-13);
  CHECK(axes.loop.impulse(limit).isZero(0));
  CHECK(axes.rate() == Approx(0.1).epsilon(1e-13));
}

// Both rows lie on one axis: the motor's is met alone, to the tolerance 1e-13 of the solver.
TEST_CASE("a limit lets go what a motor pulls off it") {
  for (const double sign : {1.0, -1.0}) {
    Axes axes;
    Limit<Turn>::Item stop{.a = axes.ground, .b = axes.axle};
    (sign > 0 ? stop.lower : stop.upper) = 0;
    const auto limit = axes.loop.add(stop);
    axes.loop.add(Motor<Turn>::Item{.a = axes.ground, .b = axes.axle, .speed = sign});
    const StepReport report = axes.loop.step(h);
    CHECK(report.status == Status::converged);
    CHECK(axes.rate() == Approx(sign).epsilon(1e-12));
    CHECK(axes.loop.impulse(limit).isZero(0));
  }
}

TEST_CASE("a limit pushes back what was beyond it, without throwing it") {
  Axes axes;
  axes.loop.add(Limit<Turn>::Item{.a = axes.ground, .b = axes.axle, .upper = -0.2});
  for (int n = 0; n < 100; ++n) {
    axes.loop.step(h);
    CHECK(std::abs(axes.rate()) <= 1 + 1e-9);  // WholeViolation's push-out speed
  }
  CHECK(axes.angle() <= -0.2 + 1e-9);
}

// From rest with moment F on inertia I: ω = n h F/I to the last step before the speed, the rest in that one.
TEST_CASE("a motor pulls with exactly its cap until it has its speed, and then holds it") {
  Axes axes;
  const double moment = 0.013, force = 2.1, turning = 1.8, moving = 0.77;
  const auto motor = axes.loop.add(
      Motor<Turn>::Item{.a = axes.ground, .b = axes.axle, .speed = turning, .max_force = moment});
  const auto thrust = axes.loop.add(
      Motor<Slide>::Item{.a = axes.rail, .b = axes.bearing, .speed = -moving, .max_force = force});
  for (int n = 1; n <= 60; ++n) {
    axes.loop.step(h);
    const double w = n * h * moment / inertia, v = n * h * force / mass;
    // The solver's 1e-13 a step, sixty times over.
    CHECK(std::abs(axes.rate() - std::min(w, turning)) <= 1e-11);
    CHECK(std::abs(axes.speed() + std::min(v, moving)) <= 1e-11);
    if (w < turning) CHECK(axes.loop.impulse(motor)[0] == h * moment);
    if (v < moving) CHECK(axes.loop.impulse(thrust)[0] == -h * force);
  }
  CHECK(std::abs(axes.loop.impulse(motor)[0]) <= 1e-13);
}

// Coulomb's dry friction with a moment F: ω falls by h F/I a step and then is zero; below F nothing moves.
TEST_CASE("a motor of speed 0 is dry friction: it stops the axis, and holds what is below its cap") {
  Axes axes;
  axes.loop.add(Motor<Turn>::Item{.a = axes.ground, .b = axes.axle, .max_force = 0.02});
  axes.spin(2.0);
  for (int n = 1; n <= 40; ++n) {
    axes.loop.step(h);
    CHECK(std::abs(axes.rate() - std::max(0.0, 2.0 - n * h * 0.02 / inertia)) <= 1e-11);
  }
  const double angle = axes.angle();
  for (int n = 0; n < 100; ++n) {
    axes.set().apply_torque(axes.wheel, {0, 0, 0.0199});
    axes.loop.step(h);
  }
  CHECK(std::abs(axes.angle() - angle) <= 1e-12);
  axes.set().apply_torque(axes.wheel, {0, 0, 0.03});
  axes.loop.step(h);
  CHECK(axes.rate() == Approx(h * 0.01 / inertia).epsilon(1e-9));
}

// One step: I (ω⁺ − ω) = −h (k (θ + h ω⁺ − θ*) + c ω⁺), by hand.
TEST_CASE("a step of a drive is implicit Euler's of its spring and damper, at any stiffness") {
  for (const double k : {1.0, 1e3, 1e6, 1e9}) {
    Axes axes;
    const double c = 0.01 * std::sqrt(k), target = 0.3, speed = 0.2, w = 0.5;
    axes.loop.add(Drive<Turn>::Item{
        .a = axes.ground, .b = axes.axle, .target = target, .stiffness = k, .damping = c, .speed = speed});
    axes.loop.add(Drive<Slide>::Item{
        .a = axes.rail, .b = axes.bearing, .target = target, .stiffness = k, .damping = c});
    axes.spin(w);
    axes.push(w);
    axes.loop.step(h);
    const double stiff = h * (h * k + c);
    CAPTURE(k);
    CHECK(axes.rate() ==
          Approx((inertia * w + h * k * target + stiff * speed) / (inertia + stiff)).epsilon(1e-10));
    CHECK(axes.speed() == Approx((mass * w + h * k * target) / (mass + stiff)).epsilon(1e-10));
  }
}

TEST_CASE("a stiff drive arrives at its target over several turns, and a cap holds its force") {
  Axes axes;
  const auto drive = axes.loop.add(Drive<Turn>::Item{
      .a = axes.ground, .b = axes.axle, .target = 20, .stiffness = 50, .damping = 20, .max_force = 0.05});
  double most = 0;
  for (int n = 0; n < 1500; ++n) {
    axes.loop.step(h);
    most = std::max(most, std::abs(axes.loop.impulse(drive)[0]));
  }
  CHECK(most == h * 0.05);
  // The drive closes at k/c = 2.5 /s once it runs along its line: of 20 rad, exp(-2.5 · 13) = 1e-14 is left.
  CHECK(std::abs(axes.loop.item(drive).position - 20) <= 1e-9);
}

TEST_CASE("a motor, a drive and a limit on one axis are solved together") {
  Axes axes;
  axes.loop.add(Motor<Turn>::Item{.a = axes.ground, .b = axes.axle, .speed = 2, .max_force = 0.1});
  const auto stop = axes.loop.add(Limit<Turn>::Item{.a = axes.ground, .b = axes.axle, .upper = 1});
  for (int n = 0; n < 200; ++n) axes.loop.step(h);
  CHECK(std::abs(axes.rate()) <= 1e-9);
  CHECK(axes.loop.impulse(stop)[1] == Approx(-h * 0.1).epsilon(1e-9));
}

TEST_CASE("limits, motors and drives refuse numbers that mean nothing") {
  Axes axes;
  CHECK_THROWS_WITH(
      axes.loop.add(Limit<Turn>::Item{.a = axes.ground, .b = axes.axle, .lower = 1, .upper = 0}),
      "delassus: Limit: lower 1 must be <= upper 0");
  CHECK_THROWS_WITH(axes.loop.add(Limit<Turn>::Item{.a = axes.ground, .b = axes.axle, .restitution = 2}),
                    "delassus: Limit: restitution 2 must be in [0, 1]");
  CHECK_THROWS_WITH(axes.loop.add(Motor<Turn>::Item{.a = axes.ground, .b = axes.axle, .max_force = -1}),
                    "delassus: Motor: max_force -1 must be >= 0 N·m");
  CHECK_THROWS_WITH(axes.loop.add(Motor<Slide>::Item{.a = axes.ground, .b = axes.axle, .max_force = NAN}),
                    "delassus: Motor: max_force nan must be >= 0 N");
  CHECK_THROWS_WITH(
      axes.loop.add(Drive<Turn>::Item{.a = axes.ground, .b = axes.axle}),
      "delassus: Drive: stiffness 0 and damping 0 must be finite and >= 0, and one of them > 0");
}

// HC-34: links that whip about hit their stops again and again, many rad/s within a step. A stop that is hit
// is met within the step, to the turn that one linearisation is short of, and gives nothing back: what the
// chain has gets less but for the joints' own correction.
TEST_CASE(
    "chains of up to 32 links keep their limits to a tenth of a degree, and limits give them no energy") {
  for (const int links : {3, 10, 32}) {
    AnimationLoop loop{World{RigidBodies{}}, Constraints{Hinge{}, Limit<Turn>{}},
                       AcceleratedGaussSeidel{.tolerance = 1e-8, .max_iterations = 5000}};
    auto& set = bodies<RigidBodies>(loop.world());
    const Quat axis = frame_along({0, -1, 0});
    std::vector<ConstraintHandle<Limit<Turn>>> stops;
    Anchor end = world_anchor(Vec3::Zero(), axis);
    while (int(stops.size()) < links) {
      const double x = 0.2 * double(stops.size()) + 0.1;
      const auto link = set.add({.position = {x, 0, 0}, .mass = 1.0, .shape = Box{0.2, 0.05, 0.05}});
      const Anchor near = anchor(set, link, {-0.1, 0, 0}, axis);
      loop.add(Hinge::Item{end, near});
      stops.push_back(loop.add(Limit<Turn>::Item{.a = end, .b = near, .lower = -0.5, .upper = 0.5}));
      end = anchor(set, link, {0.1, 0, 0}, axis);
    }
    const double start = kinetic_energy(set) + potential_energy(set);
    double over = 0, gained = -1e300;
    for (int n = 0; n < 600; ++n) {
      loop.step(1.0 / 60);
      gained = std::max(gained, kinetic_energy(set) + potential_energy(set) - start);
      for (const auto& stop : stops) over = std::max(over, std::abs(loop.item(stop).position) - 0.5);
    }
    CAPTURE(links, over, gained);
    CHECK(over <= 0.1 * EIGEN_PI / 180);
    CHECK(gained <= 0);
  }
}

namespace {

/// Without gravity, for what turns about three axes.
auto free_joints() {
  AnimationLoop loop{World{RigidBodies{}}, Constraints{BallJoint{}, Hinge{}, Universal{}, Limit<Turn>{}},
                     AcceleratedGaussSeidel{.tolerance = 1e-10, .max_iterations = 5000}, WholeViolation{}};
  bodies<RigidBodies>(loop.world()).gravity.setZero();
  return loop;
}
/// 300 steps, each rounded eight times.
constexpr double rounds = 300 * 8 * 0x1p-53;

}  // namespace

// HC-34: b_z = −a_z at the start, or passed at `off` rad after 30 steps. There the twist is none, and beside
// it runs through half a turn within `off` of swing: the stop is passed by that, `position` says so, and
// takes speed only.
TEST_CASE(
    "a ball joint with a stop on its twist swings through 180 degrees, gains nothing and holds its stop "
    "again") {
  for (const auto& [off, swung] : std::vector<std::pair<double, double>>{
           {0, 0}, {1e-9, 0}, {1e-3, 0}, {0.3, 0}, {0, EIGEN_PI}, {1e-9, EIGEN_PI}})
    for (const double twist : {0.0, 1.0, -3.0}) {
      auto loop = free_joints();
      auto& set = bodies<RigidBodies>(loop.world());
      const double step = 1.0 / 60, swing = EIGEN_PI / (30 * step);
      const auto ball = set.add({.orientation = exponential<double>({swung, 0, 0}),
                                 .angular_velocity = {swing, off * swing, twist},
                                 .mass = 1.0,
                                 .inertia = Mat3(inertia * Mat3::Identity())});
      const Anchor ground = world_anchor(Vec3::Zero()), end = anchor(set, ball);
      loop.add(BallJoint::Item{ground, end});
      const auto stop = loop.add(Limit<Turn>::Item{.a = ground, .b = end, .lower = -0.5, .upper = 0.5});
      const double start = kinetic_energy(set);
      CAPTURE(off, swung, twist);
      for (int n = 0; n < 300; ++n) {
        REQUIRE(loop.step(step).status == Status::converged);
        REQUIRE(std::isfinite(loop.item(stop).position));
        REQUIRE(kinetic_energy(set) <= start * (1 + rounds));
      }
      set.place(ball, Vec3::Zero(), Quat::Identity());
      set.set_velocity(ball, Vec3::Zero(), {0.5, 0, 2});
      loop.item(stop).position = 0;
      double most = 0;
      for (int n = 0; n < 30; ++n) {
        loop.step(step);
        most = std::max(most, loop.item(stop).position);
      }
      CHECK(std::abs(most - 0.5) <= 0.1 * EIGEN_PI / 180);
    }
}

// The shaft b bends about its own arm until it lies along the arm of a, after 30 steps: a cannot turn there.
// It comes there to rounding and goes on.
TEST_CASE("a universal joint bends through 90 degrees to rounding, gains nothing and goes on") {
  auto loop = free_joints();
  auto& set = bodies<RigidBodies>(loop.world());
  const double step = 1.0 / 60, bend = EIGEN_PI / 2 / (30 * step);
  const auto a = set.add({.mass = 1.0, .shape = Box{0.1, 0.1, 1}});
  const auto b = set.add({.angular_velocity = {0, bend, 0}, .mass = 1.0, .shape = Box{0.1, 0.1, 0.6}});
  loop.add(Hinge::Item{world_anchor(Vec3::Zero()), anchor(set, a)});
  loop.add(Universal::Item{anchor(set, a), anchor(set, b)});
  const double start = kinetic_energy(set);
  double nearest = 1;
  for (int n = 0; n < 300; ++n) {
    const StepReport report = loop.step(step);
    REQUIRE(report.status == Status::converged);
    REQUIRE(report.max_joint_violation <= rounds);
    REQUIRE(std::abs(kinetic_energy(set) / start - 1) <= rounds);
    nearest =
        std::min(nearest, (set.orientation(a) * Vec3(1, 0, 0) - set.orientation(b) * Vec3(0, 0, 1)).norm());
  }
  CHECK(nearest <= 1e-3 * bend * step);
  CHECK((set.angular_velocity(b) - Vec3(0, bend, 0)).norm() <= 1e-9);
}

}  // namespace axes_tests
