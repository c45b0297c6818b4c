// Thrown and falling points in air: forces that depend on the velocity, in a body set of the test's own.
#include <delassus/delassus.hpp>
#include <delassus/steppers/bdf2.hpp>
#include <delassus/steppers/generalized_alpha.hpp>
#include <delassus/steppers/newmark.hpp>
#include <delassus/steppers/rattle.hpp>
#include <delassus/steppers/runge_kutta4.hpp>

#include "catch.hpp"
#include "convergence_order.hpp"

using namespace delassus;

namespace {

/// Points with f = −(linear + quadratic |v|) v beside their weight; an implicit integrator's A has
/// D = linear + 2 quadratic |v|, exact along v, and the runs with `quadratic` go straight down.
struct InAir : Particles {
  double linear = 0, quadratic = 0;  ///< N·s/m, N·s²/m²

  bool is_separable() const { return false; }
  void add_forces(std::span<Velocity> p) const {
    Particles::add_forces(p);
    for (const Index b : active()) p[b] -= (linear + quadratic * velocity()[b].norm()) * velocity()[b];
  }
  void factor(SystemScale scale) {
    scale_ = scale;
    Particles::factor(scale);
  }
  template <int C>
  Mat<3, C> solve_block(Index b, const Mat<3, C>& x) const {
    return x / (scale_.mass * mass(b) + scale_.damping * (linear + 2 * quadratic * velocity()[b].norm()));
  }
  using Particles::velocity;

 private:
  SystemScale scale_;
};

/// A point of 1 kg after `seconds` in steps of h.
template <class Integrator>
std::pair<Vec3, Vec3> fly(Integrator integrator, const Vec3& v, double linear, double quadratic,
                          double seconds, double h) {
  InAir air;
  air.linear = linear, air.quadratic = quadratic;
  AnimationLoop loop{World{air}, integrator};
  auto& set = loop.world().template set<0>();
  const auto point = set.add({.velocity = v, .mass = 1.0});
  for (long n = std::lround(seconds / h); n > 0; --n) loop.step(h);
  return {set.position(point), set.velocity(point)};
}

/// k/m = 0.5 1/s, thrown at (10, 10) m/s: off after 1.5 s.
template <class Integrator>
double thrown(Integrator integrator, double h) {
  const Vec3 at(10.552668945179706, 0, 1.827005415622292);
  return (fly(integrator, {10, 0, 10}, 0.5, 0, 1.5, h).first - at).norm();
}
/// Falling with a final speed of 20 m/s: off after 3 s, in place and speed.
template <class Integrator>
double fallen(Integrator integrator, double h) {
  const auto [x, v] = fly(integrator, Vec3::Zero(), 0, 9.81 / 400, 3, h);
  return std::abs(x.z() + 33.831523424479634) + std::abs(v.z() + 17.9972641684938);
}

template <class Integrator>
void check_orders(double order, Integrator integrator = {}) {
  const auto linear = convergence_orders([&](double h) { return thrown(integrator, h); }, 0.02);
  const auto quadratic = convergence_orders([&](double h) { return fallen(integrator, h); }, 0.02);
  CAPTURE(order, linear[0], linear[1], quadratic[0], quadratic[1]);
  CHECK(are_of_order(linear, order));
  CHECK(are_of_order(quadratic, order));
}

}  // namespace

// AC-02. The midpoint rule has D at the start of the step: its quadratic drag is of second order still, since
// one Newton step from there leaves the square of a change.
TEST_CASE("points in air are met by every integrator with its order") {
  check_orders<SymplecticEuler>(1);
  check_orders<LiePoisson>(1);
  check_orders<ImplicitEuler>(1);
  check_orders<ImplicitMidpoint>(2);
  check_orders<Rattle>(2);
  check_orders<GeneralizedAlpha>(2);
  check_orders<Newmark>(2);
  check_orders<Bdf2>(2);
}

// Orders from a tenth of a second on, above rounding; 1e-10 is asked for, of the way.
TEST_CASE("points in air are met by Runge-Kutta with fourth order, and to 1e-10 at a hundredth of a second") {
  for (const auto& orders : {convergence_orders([](double h) { return thrown(RungeKutta4{}, h); }, 0.1),
                             convergence_orders([](double h) { return fallen(RungeKutta4{}, h); }, 0.1)}) {
    CAPTURE(orders[0], orders[1]);
    CHECK(are_of_order(orders, 4));
  }
  CAPTURE(thrown(RungeKutta4{}, 1e-2), fallen(RungeKutta4{}, 1e-2));
  CHECK(thrown(RungeKutta4{}, 1e-2) <= 1e-10 * 10.55);
  CHECK(fallen(RungeKutta4{}, 1e-2) <= 1e-10 * 33.83);
}

// Without air the midpoint rule, Störmer and Verlet's method and Runge-Kutta are exact.
TEST_CASE("a thrown point flies the exact parabola where the method is exact") {
  const Vec3 at(15, 0, 15 - 0.5 * 9.81 * 2.25);
  CHECK((fly(ImplicitMidpoint{}, {10, 0, 10}, 0, 0, 1.5, 0.01).first - at).norm() <= 1e-12);
  CHECK((fly(Rattle{}, {10, 0, 10}, 0, 0, 1.5, 0.01).first - at).norm() <= 1e-12);
  CHECK((fly(RungeKutta4{}, {10, 0, 10}, 0, 0, 1.5, 0.01).first - at).norm() <= 1e-12);
}
