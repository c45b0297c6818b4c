// More scenes whose true error follows the one that is asked for: joints, friction, soft bodies.
#include <delassus/fem/elasticity/st_venant_kirchhoff.hpp>
#include <delassus/fem/tetrahedral_fem.hpp>
#include <delassus/geometry/box_mesh.hpp>
#include <delassus/schemes/error_controlled.hpp>
#include <delassus/steppers/newton_midpoint.hpp>

#include "scenes.hpp"
#include "true_error.hpp"

#include <cmath>
#include <numbers>
#include <utility>
#include <vector>

#include "catch.hpp"

namespace error_controlled_accuracy_tests {

using namespace scenes;
using namespace true_error;

namespace {

/// A double pendulum of rods of 1 m and 1 kg, let go level, after 2 s.
template <class Integrator>
Vec3 double_pendulum(double accuracy, const Integrator& integrator) {
  AnimationLoop loop{World{RigidBodies{}}, Constraints{BallJoint{}}, Integrator{integrator}, PositionProjection{.rate = 1},
                     AcceleratedGaussSeidel{.tolerance = 1e-10}, ErrorControlled{.accuracy = accuracy}};
  auto& set = rigid_bodies(loop);
  const Mat3 inertia = Vec3(0.01, 0.1, 0.1).asDiagonal();
  const auto upper = set.add({.position = {0.5, 0, 0}, .mass = 1, .inertia = inertia}), lower = set.add({.position = {1.5, 0, 0}, .mass = 1, .inertia = inertia});
  loop.add(BallJoint::Item{world_anchor({0, 0, 0}), anchor_at(set, upper, Vec3(0, 0, 0))});
  loop.add(BallJoint::Item{anchor_at(set, upper, Vec3(1, 0, 0)), anchor_at(set, lower, Vec3(1, 0, 0))});
  for (int i = 0; i < 20; ++i) loop.step(0.1);
  CHECK((set.position(upper) - set.orientation(upper) * Vec3(0.5, 0, 0)).norm() < 1e-2 * accuracy + 1e-9);
  return set.position(lower);
}

/// Leads a floor to and fro.
struct Shaken {
  using plays = role::Listener;
  using listens = Listens<>;
  RigidBodies::Handle floor{};
  double amplitude = 0.1, rate = 2 * std::numbers::pi;
  void lead(auto& world, double t, double h) const { bodies<RigidBodies>(world).move_to(floor, {amplitude * std::sin(rate * (t + h)), 0, 0}); }
};

}  // namespace

TEST_CASE("the error of a double pendulum follows the accuracy, and its joints are closed") {
  const Vec3 reference = double_pendulum(1e-8, NewtonMidpoint{});
  const auto error = [&](auto integrator) {
    return [&reference, integrator](double accuracy) { return (double_pendulum(accuracy, integrator) - reference).norm() / std::sqrt(2.5 * 0.1); };
  };
  follows(error(ImplicitMidpoint{}), 0.05, 10);
  follows(error(NewtonMidpoint{}), 0.05, 10);
}

// Coulomb's block stops after v²/(2 µ g). Each decade costs a few steps, all of them where it stops.
TEST_CASE("a sliding block stops where it should") {
  for (const double accuracy : {1e-2, 1e-4, 1e-6}) {
    AnimationLoop loop{World{RigidBodies{}}, Constraints{Contact{Coulomb{.friction = 0.3}}}, ImplicitMidpoint{}, PositionProjection{},
                       AcceleratedGaussSeidel{.tolerance = 1e-9}, ErrorControlled{.accuracy = accuracy}};
    auto& set = rigid_bodies(loop);
    set.add_fixed(HalfSpace{});
    const auto block = set.add({.position = {0, 0, 0.1}, .velocity = {2, 0, 0}, .mass = 1, .shape = Box{0.2, 0.2, 0.2}});
    Work work;
    for (int i = 0; i < 10; ++i) loop.step(0.1), work.add(error_report(loop));
    CHECK(std::abs(set.position(block).x() - 4 / (2 * 0.3 * g)) <= accuracy * 0.1 * std::sqrt(3));
    CHECK(work.steps < 60);
  }
}

// A block on a floor that goes to and fro with 3.9 m/s² at most, and friction for 2.9: it sticks and slips. The closed form is
// piecewise a parabola or the floor's sine, from event to event.
TEST_CASE("a block on a shaken floor sticks and slips by what is asked") {
  const double mu = 0.3, A = 0.1, rate = 2 * std::numbers::pi;
  std::vector<double> exact;
  {
    double x = 0, v = A * rate, t = 0;
    bool slips = false;
    int sign = 0;
    const double dt = 1e-6;  // events to a microsecond, arcs in closed form of second order
    for (int i = 1; i <= 2000000; ++i, t += dt) {
      const double acceleration = -A * rate * rate * std::sin(rate * (t + dt)), floor = A * rate * std::cos(rate * (t + dt));
      if (!slips && std::abs(acceleration) > mu * g) slips = true, sign = acceleration > 0 ? 1 : -1;
      const double before = v;
      if (slips) {
        v += sign * mu * g * dt;
        if (sign * (floor - v) <= 0) {
          v = floor;
          slips = std::abs(acceleration) > mu * g;
          sign = acceleration > 0 ? 1 : -1;
        }
      } else {
        v = floor;
      }
      x += 0.5 * (before + v) * dt;
      if (i % 100000 == 0) exact.push_back(x);
    }
  }
  for (const double accuracy : {1e-2, 1e-3, 1e-4}) {
    AnimationLoop loop{World{RigidBodies{}}, Constraints{Contact{Coulomb{.friction = mu}}}, ImplicitMidpoint{}, PositionProjection{},
                       AcceleratedGaussSeidel{.tolerance = 1e-9}, Shaken{}, ErrorControlled{.accuracy = accuracy}};
    auto& set = rigid_bodies(loop);
    loop.data().get<Shaken>().floor = set.add({.shape = HalfSpace{}, .motion = Motion::kinematic});
    const auto block = set.add({.position = {0, 0, 0.1}, .velocity = {A * rate, 0, 0}, .mass = 1, .shape = Box{0.4, 0.4, 0.2}});
    double worst = 0;
    for (const double x : exact) {
      loop.step(0.1);
      worst = std::max(worst, std::abs(set.position(block).x() - x) / 0.3);
    }
    INFO("accuracy " << accuracy << ", true error " << worst);
    CHECK(worst <= 10 * accuracy);
  }
}

// Elements couple their nodes beyond the order of the integrator: the halves are taken, by error per step, whose slope is ½ for
// first order. The reference is the same at an accuracy of 1e-6.
TEST_CASE("a soft beam that is let go errs less where less is asked") {
  const auto tip = [](double accuracy) {
    using Soft = TetrahedralFem<StVenantKirchhoff>;
    AnimationLoop loop{World{Soft{}}, ImplicitMidpoint{}, ErrorControlled{.accuracy = accuracy}};
    auto& set = bodies<Soft>(loop.world());
    const auto beam = set.add({.mesh = box_mesh({1, 0.1, 0.1}, {6, 1, 1}), .elasticity = {.young = 1e6, .poisson = 0.3}, .density = 1000});
    set.fix(beam, [](const Vec3& x) { return x.x() < 1e-6; });
    for (int i = 0; i < 3; ++i) loop.step(0.1);
    return set.position(set.node(beam, 6));
  };
  const Vec3 reference = tip(1e-6);
  std::vector<std::pair<double, double>> points;
  for (const double accuracy : {1e-2, 1e-3, 1e-4}) points.emplace_back(accuracy, (tip(accuracy) - reference).norm() / 0.5);
  CHECK(slope(points) >= 0.4);
  CHECK(points.back().second <= 20 * 1e-4);
}

}  // namespace error_controlled_accuracy_tests
