// The order of every integrator on a smooth force, where it is a row of the table of docs/evidence/integrators.md;
// joints and free rotation of those that have no test of their own for it.
#include <delassus/schemes/substeps.hpp>
#include <delassus/steppers/bdf2.hpp>
#include <delassus/steppers/generalized_alpha.hpp>
#include <delassus/steppers/newmark.hpp>
#include <delassus/steppers/newton_midpoint.hpp>
#include <delassus/steppers/rattle.hpp>
#include <delassus/steppers/runge_kutta4.hpp>

#include "catch.hpp"
#include "convergence_order.hpp"
#include "integrators/euler_top.hpp"
#include "integrators/oscillator.hpp"
#include "loop/smooth_scenes.hpp"

using namespace delassus;

namespace {

/// A mass on a spring after two and a fifth periods, in place and in speed over ω.
template <class Integrator, class... Scheme>
double off(double h, Scheme... scheme) {
  auto [loop, mass] = oscillator::make(Integrator{}, oscillator::omega, scheme...);
  auto& set = bodies<Particles>(loop.world());
  for (long n = std::lround(2.2 / h); n > 0; --n) loop.step(h);
  const double phase = oscillator::omega * 2.2;
  return std::hypot(set.position(mass).x() - std::cos(phase),
                    set.velocity(mass).x() / oscillator::omega + std::sin(phase));
}

/// In whole steps, and in steps of which each is taken in three parts.
template <class Integrator>
void check_spring(double order) {
  for (const auto& orders :
       {convergence_orders([](double h) { return off<Integrator>(h); }, 2.2 / 220),
        convergence_orders([](double h) { return off<Integrator>(h, Substeps{3}); }, 2.2 / 110)}) {
    CAPTURE(order, orders[0], orders[1]);
    CHECK(are_of_order(orders, order));
  }
}

}  // namespace

TEST_CASE("every integrator meets a spring with its order, in whole steps and in substeps") {
  check_spring<SymplecticEuler>(1);
  check_spring<LiePoisson>(1);
  check_spring<ImplicitEuler>(1);
  check_spring<ImplicitMidpoint>(2);
  check_spring<Rattle>(2);
  check_spring<GeneralizedAlpha>(2);
  check_spring<Newmark>(2);
  check_spring<Bdf2>(2);
  check_spring<RungeKutta4>(4);
}

// It moves rigid bodies, and takes forces that vary from joints: a soft length of 2 m from the world, on
// which a body swings 1 m in and out as cos ω t.
TEST_CASE("the midpoint rule by Newton's method meets a soft joint with second order") {
  const auto orders = convergence_orders(
      [](double h) {
        AnimationLoop loop{World{RigidBodies{}}, Constraints{DistanceJoint{}}, NewtonMidpoint{}};
        auto& set = bodies<RigidBodies>(loop.world());
        set.gravity.setZero();
        const auto mass = set.add({.position = {3, 0, 0}, .mass = 1.0, .inertia = Mat3(Mat3::Identity())});
        loop.add(DistanceJoint::Item{.a = anchor(set, mass),
                                     .b = world_anchor(Vec3::Zero()),
                                     .length = 2,
                                     .stiffness = oscillator::omega * oscillator::omega});
        for (long n = std::lround(2.2 / h); n > 0; --n) loop.step(h);
        const double phase = oscillator::omega * 2.2;
        return std::hypot(set.position(mass).x() - 2 - std::cos(phase),
                          set.velocity(mass).x() / oscillator::omega + std::sin(phase));
      },
      2.2 / 220);
  CAPTURE(orders[0], orders[1]);
  CHECK(are_of_order(orders, 2));
}

TEST_CASE(
    "the midpoint rule by Newton's method meets the Euler top with second order, and keeps it to rounding") {
  const auto orders = convergence_orders(
      [](double h) { return euler_top::after_ten_seconds(NewtonMidpoint{}, int(std::lround(10 / h))).angle; },
      1.0 / 40);
  CAPTURE(orders[0], orders[1]);
  CHECK(are_of_order(orders, 2));
  const auto run = euler_top::after_ten_seconds(NewtonMidpoint{}, 1600);
  CHECK(run.angle <= 1.5 * 5.86e-5);
  CHECK(run.momentum <= 1.5e-14);
  CHECK(run.energy <= 1.5e-14);
}

namespace {

/// The pendulum of AC-08 after a second.
template <class Integrator, class Stabilisation>
double swung(double h) {
  auto loop =
      smooth::pendulum(Integrator{}, Stabilisation{}, GaussSeidel{.tolerance = 1e-14, .max_iterations = 100});
  return (smooth::end_of(smooth::run(loop, 1, h)) - Vec3(-0.986291751131875, 0, -0.165010853125541)).norm();
}

}  // namespace

TEST_CASE("implicit Euler and the splitting meet a pendulum on a rigid length with first order") {
  for (const auto& orders : {convergence_orders(swung<ImplicitEuler, WholeViolation>, 1.0 / 200),
                             convergence_orders(swung<LiePoisson, WholeViolation>, 1.0 / 200)}) {
    CAPTURE(orders[0], orders[1]);
    CHECK(are_of_order(orders, 1));
  }
}

// Its constant at 10 s and h = 0.01 is 4.8e-3 m, as that of the rule solved to the end; with the whole
// violation it is in constraints/distance_joint.cpp.
TEST_CASE("the midpoint rule with projected positions meets a pendulum on a rigid length with second order") {
  const auto orders = convergence_orders(swung<ImplicitMidpoint, PositionProjection>, 1.0 / 200);
  CAPTURE(orders[0], orders[1]);
  CHECK(are_of_order(orders, 2));
  auto loop = smooth::pendulum(ImplicitMidpoint{}, PositionProjection{.rate = 1},
                               GaussSeidel{.tolerance = 1e-14, .max_iterations = 100});
  CHECK((smooth::end_of(smooth::run(loop, 10, 0.01)) - smooth::pendulum_at_ten()).norm() <= 1.5 * 4.8e-3);
}

// As symplectic Euler's, whose steps these are: the amplitude is 10.0126 below 2, and beyond each step
// multiplies by 1.22.
TEST_CASE("the splitting is bounded at h w = 1.99 and grows at 2.01") {
  const auto farthest = [](double edge) {
    auto [loop, mass] = oscillator::make(LiePoisson{}, edge);
    auto& set = bodies<Particles>(loop.world());
    double most = 0;
    for (int n = 0; n < 10000 && most < 1e6; ++n) {
      loop.step(1.0);
      most = std::max(most, std::abs(set.position(mass).x()));
    }
    return most;
  };
  CHECK(farthest(1.99) <= 10.0126);
  CHECK(farthest(2.01) >= 1e6);
}
