#include <delassus/integrators/lie_poisson.hpp>

#include "catch.hpp"
#include "convergence_order.hpp"
#include "integrators/euler_top.hpp"
#include "integrators/free_fall.hpp"

using namespace delassus;

// The constants at h = 1/160: 2.14e-5 rad, and 4e-8 of the energy. L is off by 6.7e-15, where [Verification]
// has 1e-14.
TEST_CASE(
    "the splitting meets the Euler top with second order, keeps L to rounding and the energy to its "
    "constant") {
  const auto orders = convergence_orders(
      [](double h) { return euler_top::after_ten_seconds(LiePoisson{}, int(std::lround(10 / h))).angle; },
      1.0 / 40);
  CAPTURE(orders[0], orders[1]);
  CHECK(are_of_order(orders, 2));
  const auto run = euler_top::after_ten_seconds(LiePoisson{}, euler_top::steps_of_constant);
  CHECK(run.angle <= 1.5 * 2.14e-5);
  CHECK(run.energy <= 1.5 * 4e-8);
  CHECK(run.momentum <= 1e-14);
}

TEST_CASE("the splitting is of second order whatever the axes the inertia is given in") {
  const Quat frame = exponential<double>({0.3, -0.5, 0.9});
  const auto orders = convergence_orders(
      [&](double h) {
        return euler_top::after_ten_seconds(LiePoisson{}, int(std::lround(10 / h)), frame).angle;
      },
      1.0 / 40);
  CAPTURE(orders[0], orders[1]);
  CHECK(are_of_order(orders, 2));
}

// The energy swings with the angle and does not drift: over a hundred times as long its bound is that of ten
// seconds, the amplitude of h²; ten times the constant above lies between that and what a drift of its size
// in 10 s would give, 1e-5.
TEST_CASE("the energy of the splitting is bounded over a thousand seconds") {
  AnimationLoop loop{World{RigidBodies{}}, LiePoisson{}};
  auto& set = bodies<RigidBodies>(loop.world());
  set.gravity.setZero();
  set.add({.angular_velocity = {1, 1, 1}, .mass = 1.0, .inertia = Mat3(Vec3(1, 2, 3).asDiagonal())});
  const double start = kinetic_energy(set);
  double early = 0, late = 0;
  for (int n = 0; n < 100000; ++n) {
    loop.step(0.01);
    (n < 50000 ? early : late) =
        std::max(n < 50000 ? early : late, std::abs(kinetic_energy(set) / start - 1));
  }
  CHECK(late <= 1.01 * early);
  CHECK((early >= 1e-8 && early <= 1e-4));
}

// As for symplectic Euler: the force is constant. 60 steps round v and x once each.
TEST_CASE("a body falls by g h^2 n(n+1)/2 in n steps of the splitting") {
  const double h = 1.0 / 60;
  REQUIRE(free_fall::worst_error(LiePoisson{}, 60,
                                 [&](int n) { return -free_fall::g * h * h * n * (n + 1) / 2; }) <= 1e-13);
}
