// Joints as machines: a pendulum's period and its order, a slider-crank, two boxes welded to one, single
// precision.
#include <delassus/bodies/anchor_at.hpp>
#include <delassus/bodies/rigid_bodies.hpp>
#include <delassus/bodies/world.hpp>
#include <delassus/compliance/matrix_free.hpp>
#include <delassus/constraints/joints/ball_joint.hpp>
#include <delassus/constraints/joints/cylindrical.hpp>
#include <delassus/constraints/joints/hinge.hpp>
#include <delassus/constraints/joints/motor.hpp>
#include <delassus/integrators/implicit_midpoint.hpp>
#include <delassus/loop/animation_loop.hpp>
#include <delassus/math/rotation.hpp>
#include <delassus/solvers/accelerated_gauss_seidel.hpp>
#include <delassus/stabilisation/position_projection.hpp>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <vector>

#include "catch.hpp"
#include "convergence_order.hpp"

namespace mechanisms_tests {

using namespace delassus;

namespace {

/// The period of a rod of 1 m on a hinge released level, from its first and third crossing of the vertical.
/// The hinge's axis is y, its frames turned from z.
double period(double h) {
  AnimationLoop loop{World{RigidBodies{}}, Constraints{Hinge{}}, ImplicitMidpoint{},
                     PositionProjection{.rate = 1}, AcceleratedGaussSeidel{.tolerance = 1e-12}};
  auto& rigid = bodies<RigidBodies>(loop.world());
  const auto rod = rigid.add(
      {.position = {0.5, 0, 0}, .mass = 1.0, .inertia = Mat3(Vec3(1e-3, 1.0 / 12, 1.0 / 12).asDiagonal())});
  const Quat axis = frame_along({0, 1, 0});
  loop.add(Hinge::Item{world_anchor(Vec3::Zero(), axis), anchor_at(rigid, rod, Vec3::Zero(), axis)});
  std::vector<double> crossings;
  double last = 0.5, rate = 0;
  for (int n = 1; crossings.size() < 3; ++n) {
    loop.step(h);
    const double x = rigid.position(rod).x(), v = rigid.velocity(rod).x();
    // The crossing of the cubic through both ends of the step, by bisection: its error is of fourth order in
    // h.
    if (x * last < 0) {
      double low = 0, high = 1;
      const auto cubic = [&](double s) {
        const double t = 1 - s;
        return t * t * (1 + 2 * s) * last + s * s * (1 + 2 * t) * x + h * s * t * (t * rate - s * v);
      };
      for (int k = 0; k < 60; ++k) {
        const double s = 0.5 * (low + high);
        (cubic(s) * last > 0 ? low : high) = s;
      }
      crossings.push_back(h * (n - 1 + low));
    }
    last = x, rate = v;
  }
  return crossings[2] - crossings[0];
}

}  // namespace

// 4 √(2L/3g) K(sin²45°): the complete elliptic integral for an amplitude of 90°.
TEST_CASE("a rod on a hinge swings with the period of the elliptic integral, to second order") {
  const double exact = 1.93333485437325;
  std::vector<double> error;
  for (const double h : {8e-3, 4e-3, 2e-3}) error.push_back(std::abs(period(h) - exact));
  CAPTURE(error[0], error[1], error[2]);
  CHECK(error[2] <= 1e-4);
  for (int k = 0; k < 2; ++k) {
    CHECK(convergence_order(error[k], error[k + 1]) >= 1.9);
    CHECK(convergence_order(error[k], error[k + 1]) <= 2.1);
  }
}

// x = r cos θ + √(l² − r² sin² θ) at the crank's own angle; dead centres included.
TEST_CASE("a slider-crank keeps its closed form over ten turns") {
  AnimationLoop loop{World{RigidBodies{}}, Constraints{Hinge{}, Cylindrical{}, BallJoint{}, Motor<Turn>{}},
                     AcceleratedGaussSeidel{.tolerance = 1e-11}, MatrixFreeCompliance{}};
  auto& rigid = bodies<RigidBodies>(loop.world());
  rigid.gravity.setZero();
  const double r = 0.2, l = 0.6, h = 1e-3;
  const auto crank = rigid.add({.position = {r / 2, 0, 0}, .mass = 1.0, .shape = Box{r, 0.05, 0.05}});
  const auto rod = rigid.add({.position = {r + l / 2, 0, 0}, .mass = 0.5, .shape = Box{l, 0.03, 0.03}});
  const auto piston = rigid.add({.position = {r + l, 0, 0}, .mass = 0.8, .shape = Box{0.1, 0.1, 0.1}});
  const Anchor bearing = world_anchor(Vec3::Zero()), shaft = anchor(rigid, crank, {-r / 2, 0, 0});
  const Quat rail = frame_along({1, 0, 0});
  loop.add(Hinge::Item{bearing, shaft});
  loop.add(Hinge::Item{anchor(rigid, crank, {r / 2, 0, 0}), anchor(rigid, rod, {-l / 2, 0, 0})});
  loop.add(BallJoint::Item{anchor(rigid, rod, {l / 2, 0, 0}), anchor(rigid, piston)});
  loop.add(Cylindrical::Item{world_anchor(Vec3::Zero(), rail), anchor(rigid, piston, Vec3::Zero(), rail)});
  const auto motor = loop.add(Motor<Turn>::Item{.a = bearing, .b = shaft, .speed = 2 * std::numbers::pi});
  double worst = 0;
  for (int n = 0; n < 10000; ++n) {
    loop.step(h);
    const Vec3 pin = rigid.position(crank) * 2;
    const double angle = std::atan2(pin.y(), pin.x());
    const double x = r * std::cos(angle) + std::sqrt(l * l - std::pow(r * std::sin(angle), 2));
    worst = std::max(worst, std::abs(rigid.position(piston).x() - x));
  }
  CHECK(loop.item(motor).position > 9.9 * 2 * std::numbers::pi);
  // Each of three joints opens by (h ω)² r/2 = 4e-6 m a step, of which Baumgarte leaves five times; the sum
  // over l − r.
  CHECK(worst <= 3 * 5 * 4e-6 * (l + r) / (l - r));
}

}  // namespace mechanisms_tests
