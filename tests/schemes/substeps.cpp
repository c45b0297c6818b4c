// Several steps in one.
#include <delassus/schemes/substeps.hpp>
#include <delassus/steppers/newton_midpoint.hpp>
#include <delassus/steppers/rattle.hpp>
#include <delassus/steppers/runge_kutta4.hpp>

#include "convergence_order.hpp"
#include "scenes.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "catch.hpp"

namespace substeps_tests {

using namespace scenes;

// Without contacts the parts are steps: same bits.
TEST_CASE("four substeps are four steps of a quarter where there are no contacts, to the bit") {
  const auto tumble = [](auto scheme, int count) {
    AnimationLoop loop{World{RigidBodies{}}, LiePoisson{}, scheme};
    auto& set = rigid_bodies(loop);
    const auto box = set.add({.angular_velocity = {1, 2, 3}, .mass = 1.0, .shape = Box{1, 2, 3}});
    for (int n = 0; n < 20 * count; ++n) loop.step(0.04 / count);
    REQUIRE(loop.time() == Approx(0.8).epsilon(1e-14));
    return std::pair{set.position(box), set.orientation(box)};
  };
  const auto parts = tumble(Substeps{4}, 1), steps = tumble(PlainOrder{}, 4);
  CHECK(parts.first == steps.first);
  CHECK(parts.second.coeffs() == steps.second.coeffs());
}

TEST_CASE("a load acts over the whole of a divided step, and a kinematic body arrives at its end") {
  AnimationLoop loop{World{RigidBodies{}}, Substeps{5}};
  auto& set = rigid_bodies(loop);
  set.gravity.setZero();
  const auto pushed = set.add({.mass = 2.0, .shape = Sphere{1}});
  const auto moved = set.add({.motion = Motion::kinematic});
  set.apply_force(pushed, {4, 0, 0});
  set.move_to(moved, {1, 2, 3});
  loop.step(0.1);
  CHECK(set.velocity(pushed).x() == Approx(0.2).epsilon(1e-14));
  CHECK(set.position(moved) == Vec3(1, 2, 3));
  loop.step(0.1);
  CHECK(set.velocity(pushed).x() == Approx(0.2).epsilon(1e-14));  // it acted once
  CHECK(set.position(moved) == Vec3(1, 2, 3));
}

TEST_CASE("a body that stays where it was is counted once, in however many parts") {
  AnimationLoop loop{World{RigidBodies{}}, Substeps{4}};
  auto& set = rigid_bodies(loop);
  const auto sick = set.add({.mass = 2.0, .shape = Sphere{1}});
  set.add({.position = {9, 0, 0}, .mass = 2.0, .shape = Sphere{1}});
  set.loads()[sick.index][0] = std::numeric_limits<double>::quiet_NaN();
  const StepReport report = loop.step(0.1);
  CHECK(report.quarantined == 1);
  CHECK(report.status == Status::quarantined);
}

namespace {

/// A ball that rolls, a box that slides and a box that falls over its edge, all on one plane.
template <class... Scheme>
auto on_a_plane(Scheme... scheme) {
  AnimationLoop loop{World{RigidBodies{}}, Constraints{Contact{Coulomb{.friction = 0.3}}, BallJoint{}},
                     scheme...};
  auto& set = rigid_bodies(loop);
  set.add_fixed(HalfSpace{});
  set.add({.position = {0, 0, 0.2},
           .velocity = {2, 0, 0},
           .angular_velocity = {0, 10, 0},
           .mass = 1.0,
           .shape = Sphere{0.2}});
  set.add({.position = {0, 3, 0.25}, .velocity = {5, 0, 0}, .mass = 1.0, .shape = Box{0.5, 0.5, 0.5}});
  set.add({.position = {0, 6, 0.55},
           .orientation = exponential<double>({0, 0.9, 0}),
           .mass = 1.0,
           .shape = Box{0.5, 0.5, 1}});
  return loop;
}

}  // namespace

// The ball keeps rolling. The box stops after v²/(2 μ g) = 4.2475 m, early by at most h v.
TEST_CASE("a ball rolls on, a box slides as far, and nothing sinks in under substeps") {
  auto loop = on_a_plane(Substeps{4});
  auto& set = rigid_bodies(loop);
  const double h = 1.0 / 60;
  double deepest = 0;
  for (int n = 0; n < 180; ++n) deepest = std::max(deepest, loop.step(h).max_penetration);
  CHECK(set.velocity(set.handle(1)).x() == Approx(2).epsilon(1e-3));
  CHECK(set.position(set.handle(2)).x() == Approx(25 / (2 * 0.3 * g)).margin(5 * h));
  CHECK(set.velocity(set.handle(2)).norm() <= 1e-6);
  // The first meeting may go below by what the turned edge falls in a step, h²g, and by its turn, (h ω)² of
  // half a diagonal.
  CHECK(deepest <= h * h * g + h * h * 9 * 0.6);
  CHECK(set.position(set.handle(3)).z() == Approx(0.25).margin(2e-3));
}

// On ice all four carry the same.
TEST_CASE("the corners of a box that slides on ice carry the same under substeps") {
  AnimationLoop loop{World{RigidBodies{}}, Constraints{Contact{Coulomb{.friction = 0}}, BallJoint{}},
                     Substeps{4}};
  auto& set = rigid_bodies(loop);
  set.add_fixed(HalfSpace{});
  set.add({.position = {0, 0, 0.25}, .velocity = {6, 0, 0}, .mass = 1.0, .shape = Box{0.5, 0.5, 0.5}});
  for (int n = 0; n < 30; ++n) loop.step(1.0 / 60);
  REQUIRE(loop.contacts().size() == 4);
  for (const ContactResult& c : loop.contacts())
    CHECK(std::abs(c.impulse.z()) == Approx(g / 60 / 4).epsilon(1e-3));
}

// Energy is kept, and so is the amplitude. Contact points that stayed those of the start of the step made 0.15 rad grow to 0.4 … 0.7.
TEST_CASE("an ellipsoid that rocks without slip keeps its amplitude, in however many parts") {
  for (const int count : {2, 4, 8})
    for (const double h : {1.0 / 60, 1.0 / 240}) {
      CAPTURE(count, h);
      AnimationLoop loop{World{RigidBodies{}}, Constraints{Contact{Coulomb{.friction = 2}}}, Substeps{count}};
      auto& set = rigid_bodies(loop);
      set.add_fixed(HalfSpace{});
      const double a = 0.3, c = 0.2, lean = 0.15;
      // Its lowest point is where the normal is −z: √(a² sin² + c² cos²) below the middle.
      const auto egg = set.add({.position = {0, 0, std::hypot(a * std::sin(lean), c * std::cos(lean))},
                                .orientation = exponential<double>({0, lean, 0}),
                                .mass = 1.0,
                                .shape = Ellipsoid{a, 0.25, c}});
      double amplitude = 0;
      for (int n = 0; n * h < 15; ++n) {
        loop.step(h);
        if (n * h > 13.5) amplitude = std::max(amplitude, 2 * std::asin(std::abs(set.orientation(egg).y())));
      }
      CHECK(amplitude == Approx(lean).epsilon(0.01));
    }
}

// The ball meets the floor in the third of four parts and is gone in the fourth: its impulse is listed.
TEST_CASE("a contact that only some parts had is listed with its impulse") {
  AnimationLoop loop{World{RigidBodies{}}, Constraints{Contact{Restitution{Coulomb{.friction = 0}, 1}}}, Substeps{4}};
  auto& set = rigid_bodies(loop);
  set.gravity.setZero();
  set.add_fixed(HalfSpace{});
  set.add({.position = {9, 0, 0.1}, .mass = 1.0, .shape = Sphere{0.1}});  // one that is there in all parts
  const auto ball = set.add({.position = {0, 0, 0.125}, .velocity = {0, 0, -1}, .mass = 2.0, .shape = Sphere{0.1}});
  const StepReport report = loop.step(0.04);
  REQUIRE(set.velocity(ball).z() == Approx(1).epsilon(1e-9));
  double up = 0;
  for (const ContactResult& c : loop.contacts()) up += c.impulse.z();
  CHECK(std::abs(up) == Approx(4).epsilon(1e-9));
  CHECK(report.contacts == Index(loop.contacts().size()));
}

// Standing still, each part carries a quarter of the weight's impulse: the sum is that of a step without
// parts.
TEST_CASE("the impulses of a divided step are the sums of its parts") {
  auto loop = on_a_plane(Substeps{4});
  auto& set = rigid_bodies(loop);
  for (int n = 0; n < 240; ++n) loop.step(1.0 / 60);
  double up = 0;
  for (const ContactResult& c : loop.contacts()) up += c.impulse.z();
  CHECK(std::abs(up) == Approx(3 * g / 60).epsilon(1e-4));
  CHECK(set.velocity(set.handle(2)).norm() <= 1e-6);
}

namespace {

struct Swing {
  Vec3 end;
  double energy = 0;  ///< the largest change on the way, J
};
/// A rod on a pin, let go level, in steps of `count` parts.
template <class Integrator, class... Policies>
Swing swing(int count, double h, double seconds, Policies... policies) {
  AnimationLoop loop{World{RigidBodies{}}, Constraints{BallJoint{}}, Integrator{}, Substeps{count},
                     policies...};
  auto& set = rigid_bodies(loop);
  const auto rod = set.add(
      {.position = {0.5, 0, 0}, .mass = 1.0, .inertia = Mat3(Vec3(1e-3, 1. / 12, 1. / 12).asDiagonal())});
  loop.add(BallJoint::Item{anchor(set, rod, {-0.5, 0, 0}), world_anchor(Vec3::Zero())});
  Swing seen;
  for (int n = 0; n < std::lround(seconds / h); ++n) {
    loop.step(h);
    seen.energy = std::max(seen.energy, std::abs(kinetic_energy(set) + potential_energy(set)));
  }
  seen.end = set.position(rod);
  return seen;
}

/// Of the rod after half a second in steps of three parts.
template <class Integrator, class... Policies>
void check_order(double order, double h, const Vec3& there, Policies... policies) {
  const auto orders = convergence_orders(
      [&](double step) { return (swing<Integrator>(3, step, 0.5, policies...).end - there).norm(); }, h);
  CAPTURE(order, orders[0], orders[1]);
  CHECK(are_of_order(orders, order));
}

}  // namespace

// The reference is Runge-Kutta's at 1/3200 s: less than 1e-13 m off. What parts change of the other
// integrators shows without joints, in integrators/orders.cpp.
TEST_CASE("substeps of a rod on a pin keep the order of the integrator") {
  const Vec3 there = swing<RungeKutta4>(1, 1.0 / 3200, 0.5).end;
  const AcceleratedGaussSeidel exact{.tolerance = 1e-13};
  check_order<SymplecticEuler>(1, 1.0 / 100, there, WholeViolation{}, exact);
  check_order<ImplicitMidpoint>(2, 1.0 / 100, there, PositionProjection{.rate = 1}, exact);
  check_order<NewtonMidpoint>(2, 1.0 / 20, there);
  check_order<Rattle>(2, 1.0 / 20, there);
  check_order<RungeKutta4>(4, 1.0 / 10, there);
}

TEST_CASE("substeps of Rattle divide the swing of its energy by their square") {
  CHECK(swing<Rattle>(1, 0.02, 1).energy == Approx(16 * swing<Rattle>(4, 0.02, 1).energy).epsilon(0.1));
}

// A rod falls onto its pin: apart by 1 mm at first, closed by a fifth a part. The worst of the parts is the
// first.
TEST_CASE("the joint violation of a divided step is the worst of its parts") {
  AnimationLoop loop{World{RigidBodies{}}, Constraints{BallJoint{}}, Substeps{4}};
  auto& set = bodies<RigidBodies>(loop.world());
  set.gravity.setZero();
  const auto ball = set.add({.position = {1e-3, 0, 0}, .mass = 1.0, .shape = Sphere{0.1}});
  loop.add(BallJoint::Item{anchor(set, ball), world_anchor(Vec3::Zero())});
  CHECK(loop.step(0.01).max_joint_violation == Approx(1e-3).epsilon(1e-9));
}

}  // namespace substeps_tests
