// AC-23: Euler's disk, a thin disc that rolls round on its rim with its centre at rest.
#include "scenes.hpp"

#include "catch.hpp"

#include <algorithm>
#include <cmath>

namespace euler_disk_tests {

using namespace scenes;

namespace {

struct Spun {
  double change = 0;  ///< the largest of the energy in a second, in units of 3/2 m g a sin α
  double slip = 0;    ///< m/s, the largest of the rim's lowest point
};

/// A disc of 1 kg, a = 37.5 mm and I = m a² (¼, ¼, ½), at α to the floor, with Ω² sin α = 4 g/a: ω = Ω sin α
/// along its steepest diameter, through the point that touches.
Spun spin(double alpha, double h, auto... policies) {
  const double a = 0.0375, rate = std::sqrt(4 * g / (a * std::sin(alpha)));
  AnimationLoop loop{World{RigidBodies{}}, Constraints{Contact{Coulomb{.friction = 1}}}, policies...};
  auto& set = bodies<RigidBodies>(loop.world());
  set.add_fixed(HalfSpace{});
  const double thickness = 1e-6;
  const auto disc =
      set.add({.position = {0, 0, a * std::sin(alpha) + 0.5 * thickness * std::cos(alpha)},
               .orientation = exponential<double>({0, alpha, 0}),
               .angular_velocity = rate * std::sin(alpha) * Vec3(-std::cos(alpha), 0, std::sin(alpha)),
               .mass = 1.0,
               .inertia = Mat3(a * a * Vec3(0.25, 0.25, 0.5).asDiagonal()),
               .shape = Cylinder{a, thickness}});
  const auto energy = [&] { return kinetic_energy(set) + potential_energy(set); };
  const double start = energy();
  Spun spun;
  for (long n = std::lround(1 / h); n > 0; --n) {
    REQUIRE(loop.step(h).status <= Status::stalled);
    const Vec3 axis = set.orientation(disc) * unit_axis(2);
    const Vec3 down = (axis.z() * axis - unit_axis(2)).normalized();
    const Vec3 rim = set.velocity(disc) + set.angular_velocity(disc).cross(a * down);
    spun.slip = std::max(spun.slip, std::hypot(rim.x(), rim.y()));
    spun.change = std::max(spun.change, std::abs(energy() - start));
  }
  spun.change /= 1.5 * g * a * std::sin(alpha);
  return spun;
}

}  // namespace

// The figures: 1 % of the energy a second and 1 mm/s. Ω h is 0.008 to 0.024 here, of which the energy has the
// square. Half the step has a quarter of it: 0.173 and 0.049 % at 10°; the slip goes with the step.
TEST_CASE("Euler's disk keeps its energy and does not slip") {
  for (const double degrees : {10., 5., 1.}) {
    const double alpha = degrees * EIGEN_PI / 180;
    const Spun spun = spin(alpha, 1e-4);
    CAPTURE(degrees, spun.change, spun.slip);
    CHECK(spun.change <= 0.01);
    CHECK(spun.slip <= 1e-3);
  }
  const double coarse = spin(EIGEN_PI / 18, 1e-4).change, fine = spin(EIGEN_PI / 18, 5e-5).change;
  CAPTURE(coarse, fine);
  CHECK(fine <= coarse / 3);
}

// The rule of second order sees the rim where it touches in the middle of a step: the same figures hold at ten times the step.
TEST_CASE("Euler's disk keeps its energy and does not slip under the midpoint rule") {
  for (const double degrees : {10., 1.}) {
    const Spun spun = spin(degrees * EIGEN_PI / 180, 1e-3, ImplicitMidpoint{});
    CAPTURE(degrees, spun.change, spun.slip);
    CHECK(spun.change <= 0.01);
    CHECK(spun.slip <= 1e-3);
  }
}

}  // namespace euler_disk_tests
