// AC-08 as a constraint, by the integrators that make one solve a step and by the midpoint rule: orders and
// constants.
#include <delassus/loop/newton_midpoint.hpp>

#include "convergence_order.hpp"
#include "loop/smooth_scenes.hpp"

#include "catch.hpp"

namespace pendulum_orders_tests {

using namespace smooth;

namespace {

const GaussSeidel exact{.tolerance = 1e-14, .max_iterations = 100};
const Vec3 at_one(-0.986291751131875, 0, -0.165010853125541);

/// How far the bob is off after a second.
template <class... Policies>
auto error_of(Policies... policies) {
  return [=](double h) {
    auto loop = pendulum(policies...);
    return (end_of(run(loop, 1, h)) - at_one).norm();
  };
}

}  // namespace

// With Baumgarte's share of gaps the constant at 10 s is 2.3e-2 m at h = 0.01.
TEST_CASE("symplectic Euler meets a pendulum with first order, and within its constant") {
  const auto orders = convergence_orders(error_of(SymplecticEuler{}, WholeViolation{}, exact), 1.0 / 200);
  CAPTURE(orders[0], orders[1]);
  CHECK(are_of_order(orders, 1));
  auto loop = pendulum(SymplecticEuler{}, Baumgarte{}, exact);
  CHECK((end_of(run(loop, 10, 0.01)) - pendulum_at_ten()).norm() <= 1.5 * 2.3e-2);
}

// 4.8e-3 m at 10 s, h = 0.01. It moves rigid bodies: the bob has 1e-9 kg m², which the figure does not see.
TEST_CASE(
    "the midpoint rule solved by Newton's method meets a pendulum with second order, and within its "
    "constant") {
  const auto error = [](double h) {
    AnimationLoop loop{World{RigidBodies{}}, Constraints{BallJoint{}}, NewtonMidpoint{}};
    auto& set = bodies<RigidBodies>(loop.world());
    const auto bob = set.add({.position = {1, 0, 0}, .mass = 1.0, .inertia = Mat3(1e-9 * Mat3::Identity())});
    loop.add(BallJoint::Item{anchor(set, bob, {-1, 0, 0}), world_anchor(Vec3::Zero())});
    return (end_of(run(loop, 10, h)) - pendulum_at_ten()).norm();
  };
  const auto orders = convergence_orders(error, 1.0 / 50);
  CAPTURE(orders[0], orders[1]);
  CHECK(are_of_order(orders, 2));
  CHECK(error(0.01) <= 1.5 * 4.8e-3);
}

}  // namespace pendulum_orders_tests
