// The classical Runge-Kutta method with joints: its order and constants on the constraints themselves.
#include <delassus/steppers/runge_kutta4.hpp>

#include "convergence_order.hpp"
#include "loop/chains.hpp"
#include "loop/smooth_scenes.hpp"

#include "catch.hpp"

namespace runge_kutta4_tests {

using namespace smooth;

// AC-08 at 10 s: 4.1e-7 m at h = 0.01. The order is read where the next one, of the leak of energy, has gone.
TEST_CASE("a pendulum is met by Runge-Kutta with fourth order, and within its constant") {
  const auto error = [](double h) {
    auto loop = pendulum(RungeKutta4{});
    return (end_of(run(loop, 10, h)) - pendulum_at_ten()).norm();
  };
  const auto orders = convergence_orders(error, 1.0 / 320);
  CAPTURE(orders[0], orders[1]);
  CHECK(are_of_order(orders, 4));
  CHECK(error(0.01) <= 1.5 * 4.1e-7);
}

TEST_CASE("a double pendulum of points is met by Runge-Kutta with fourth order") {
  const auto orders = convergence_orders(
      [](double h) {
        auto loop = double_pendulum(RungeKutta4{});
        return (end_of(run(loop, 1, h)) - chains::double_pendulum_at_one()).norm();
      },
      1.0 / 50);
  CAPTURE(orders[0], orders[1]);
  CHECK(are_of_order(orders, 4));
}

TEST_CASE("two hinges in space are met by Runge-Kutta with fourth order, and stay closed") {
  auto fine = spatial(RungeKutta4{});
  const Vec3 there = end_of(run(fine, 1, 1.0 / 3200));
  double gap = 0;
  const auto orders = convergence_orders(
      [&](double h) {
        auto loop = spatial(RungeKutta4{});
        for (long n = std::lround(1 / h); n > 0; --n) gap = std::max(gap, loop.step(h).max_joint_violation);
        return (end_of(loop) - there).norm();
      },
      1.0 / 50);
  CAPTURE(orders[0], orders[1]);
  CHECK(are_of_order(orders, 4));
  CHECK(gap <= 1e-12);
}

// AC-09, as for Rattle; the mean force of a step from rest is that of its start to (h ω)².
TEST_CASE("the impulse of a joint under Runge-Kutta is the force times the step") {
  auto [loop, pivot] = rod(RungeKutta4{});
  const double h = 1e-4;
  loop.step(h);
  CHECK(loop.impulse(pivot).norm() / h == Approx(0.25 * 9.81).epsilon(1e-6));
  CHECK(largest_force(loop, pivot, h) == Approx(2.5 * 9.81).epsilon(1e-6));
}

TEST_CASE("joints that contradict each other are told, and leave all bodies as they were under Runge-Kutta") {
  CHECK(leaves_contradictions(RungeKutta4{}));
}

TEST_CASE("a force that is no number leaves all bodies where they were under Runge-Kutta") {
  CHECK(leaves_what_is_no_number(RungeKutta4{}));
}

}  // namespace runge_kutta4_tests
