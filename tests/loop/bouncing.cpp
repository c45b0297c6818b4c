#include "scenes.hpp"

#include "convergence_order.hpp"

#include "catch.hpp"

namespace bouncing_tests {

using namespace scenes;

namespace {

constexpr double radius = 0.1;

auto ball_over_plane(double restitution, double height) {
  AnimationLoop loop{World{RigidBodies{}},
                     Constraints{Contact{Restitution{Coulomb{.friction = 0.3}, restitution}}}};
  auto& set = rigid_bodies(loop);
  set.add_fixed(HalfSpace{});
  set.add({.position = {0, 0, height + radius}, .mass = 1.0, .shape = Sphere{radius}});
  return loop;
}

/// Balls of 1 kg in a row along x without gravity, `gap` apart, the first one with 1 m/s; their velocities
/// after `steps`.
std::vector<double> cradle(int count, double gap, double h, int steps, double second_mass = 1) {
  AnimationLoop loop{World{RigidBodies{}}, Constraints{Contact{Restitution{Coulomb{.friction = 0.3}, 1.0}}},
                     AcceleratedGaussSeidel{.tolerance = 1e-13}};
  auto& set = rigid_bodies(loop);
  set.gravity.setZero();
  std::vector<RigidBodies::Handle> balls;
  for (int i = 0; i < count; ++i)
    balls.push_back(set.add({.position = {i * (2 * radius + gap), 0, 0},
                             .mass = i == 1 ? second_mass : 1.0,
                             .shape = Sphere{radius}}));
  set.set_velocity(balls[0], {1, 0, 0});
  for (int n = 0; n < steps; ++n) loop.step(h);
  std::vector<double> out;
  for (const auto ball : balls) out.push_back(set.velocity(ball).x());
  return out;
}

}  // namespace

// A bounce with e = 1 keeps ½ v² + g z − ½ h g v, symplectic Euler's own energy. What varies is where the samples fall: a sample is at most ½ h² g v-steps from the apex, and the
// release height itself lies ½ g (h/2)² = 3e-4 m above the invariant's apex: 0.3 % of one metre covers both.
TEST_CASE("a ball with restitution 1 comes back to 0.3 % of its height a hundred times and never above it") {
  const double h = 1.0 / 60;
  auto loop = ball_over_plane(1, 1);
  auto& set = rigid_bodies(loop);
  const auto ball = set.handle(1);
  double apex = 0, lowest = 1, highest = 0;
  int bounces = 0;
  bool is_rising = false;
  while (bounces < 100) {
    loop.step(h);
    const double z = set.position(ball).z() - radius;
    const bool rises = set.velocity(ball).z() > 0;
    if (rises && !is_rising) apex = 0;
    apex = std::max(apex, z);
    if (!rises && is_rising) {
      ++bounces;
      lowest = std::min(lowest, apex);
      highest = std::max(highest, apex);
    }
    is_rising = rises;
    REQUIRE(loop.time() < 200);
  }
  REQUIRE(lowest >= 0.997);
  REQUIRE(highest <= 1 + 1e-13);  // four roundings a bounce
}

// A bounce is less than a step early or late, and changes nothing in those that follow. There are
// log(v/(g h))/log(1/e) of them until one is shorter than a step.
TEST_CASE(
    "a ball with restitution 0.5 lies still after the sum of its bounces, at most a step a bounce late") {
  const double sum = 1.35457092295719;  // √(2/g) (1 + e)/(1 − e), from 1 m
  for (const double h : {1e-2, 1e-3, 1e-4}) {
    auto loop = ball_over_plane(0.5, 1);
    auto& set = rigid_bodies(loop);
    const auto ball = set.handle(1);
    const double bounces = std::log2(std::sqrt(2 * g) / (g * h));
    while (loop.time() < sum + (bounces + 5) * h) loop.step(h);
    CAPTURE(h);
    for (int n = 0; n < 100; ++n) {
      REQUIRE(set.velocity(ball).norm() < g * h);
      REQUIRE(std::abs(set.position(ball).z() - radius) < g * h * h + 1e-12);
      loop.step(h);
    }
  }
}

TEST_CASE("the apex after a bounce is e^2 of the one before, to first order in the step") {
  std::vector<double> errors;
  for (const double h : {4e-3, 2e-3, 1e-3, 5e-4}) {
    auto loop = ball_over_plane(0.8, 1);
    auto& set = rigid_bodies(loop);
    const auto ball = set.handle(1);
    double apex = 0;
    bool has_bounced = false;
    for (double last = 0;; last = set.velocity(ball).z()) {
      loop.step(h);
      has_bounced = has_bounced || set.velocity(ball).z() > 0;
      if (has_bounced && set.velocity(ball).z() < 0 && last >= 0) break;
      if (has_bounced) apex = std::max(apex, set.position(ball).z() - radius);
    }
    errors.push_back(std::abs(apex - 0.64));
    // The fall ends up to one step late or early: h v = 4.4 h m of height, times the two passages.
    REQUIRE(errors.back() <= 2 * 4.43 * h);
  }
}

// Two bodies, e = 1, masses 1 and r: v_1 = (1 − r)/(1 + r), v_2 = 2/(1 + r).
TEST_CASE("an elastic pair exchanges velocities as the masses say") {
  for (const double r : {1e-3, 0.5, 1.0, 3.0, 1e3}) {
    const std::vector<double> v = cradle(2, 1e-6, 1e-3, 3, r);
    CAPTURE(r);
    REQUIRE(v[0] == Approx((1 - r) / (1 + r)).epsilon(0).margin(1e-10));
    REQUIRE(v[1] == Approx(2 / (1 + r)).epsilon(0).margin(1e-10));
  }
}

// All contacts of a step are solved together, u⁺ ≥ −e u⁻ each: touching balls give ((2 − N)/N, 2/N, …),
// Moreau's answer.
TEST_CASE("touching balls share an elastic impact as Moreau's law says") {
  for (const int count : {3, 4, 5}) {
    const std::vector<double> v = cradle(count, 0, 1e-3, 1);
    CAPTURE(count);
    REQUIRE(v[0] == Approx((2.0 - count) / count).epsilon(0).margin(1e-10));
    for (int i = 1; i < count; ++i) REQUIRE(v[i] == Approx(2.0 / count).epsilon(0).margin(1e-10));
  }
}

// A gap that is not closed within the step of the impact keeps the impacts apart: h v < gap.
TEST_CASE("balls with a gap that outlasts the step pass the impact on, the last one leaves alone") {
  for (const int count : {3, 5}) {
    const std::vector<double> v = cradle(count, 1e-6, 5e-7, 4 * count);
    CAPTURE(count);
    for (int i = 0; i + 1 < count; ++i) REQUIRE(v[i] == Approx(0).margin(1e-10));
    REQUIRE(v[count - 1] == Approx(1).epsilon(0).margin(1e-10));
  }
}

namespace {

/// The plane z = 0 with friction under a body of the given restitution.
template <class Integrator>
auto on_plane(Integrator integrator, double restitution, double friction) {
  AnimationLoop loop{World{RigidBodies{}},
                     Constraints{Contact{Restitution{Coulomb{.friction = friction}, restitution}}},
                     integrator, AcceleratedGaussSeidel{.tolerance = 1e-13}};
  rigid_bodies(loop).add_fixed(HalfSpace{});
  return loop;
}

/// How far a ball that meets the plane with e = 0.8 after 0.45 s is off at 0.8 s: the mean over 16 of them,
/// dropped so that they meet it 0, 1/16, … 15/16 of a step later.
template <class Integrator>
double off_after_bounce(double h) {
  const double e = 0.8, end = 0.8;
  double sum = 0;
  for (int k = 0; k < 16; ++k) {
    const double fall = 0.45 + h * k / 16, rise = end - fall;
    auto loop = on_plane(Integrator{}, e, 0.3);
    auto& set = rigid_bodies(loop);
    const auto ball =
        set.add({.position = {0, 0, radius + 0.5 * g * fall * fall}, .mass = 1.0, .shape = Sphere{radius}});
    for (long n = std::lround(end / h); n > 0; --n) loop.step(h);
    sum += std::abs(set.position(ball).z() - radius - (e * g * fall * rise - 0.5 * g * rise * rise));
  }
  return sum / 16;
}

/// How far a body is from its place that was thrown across a slope of angle a at v₀, with μ = 2 tan a, and
/// does not turn. ψ is the angle between its velocity and downhill, τ = tan(ψ/2), and 2 v = v₀ τ (1 + τ²), so
/// that τ + τ³/3 = 4/3 − 2 g sin a t/v₀ until it sticks, and the way is an integral over τ.
template <class Integrator>
double off_on_slope(double h, double t) {
  const double a = 0.4, v0 = 3, way = v0 * v0 / (g * std::sin(a));
  auto loop = on_plane(Integrator{}, 0, 2 * std::tan(a));
  auto& set = rigid_bodies(loop);
  set.gravity = {g * std::sin(a), 0, -g * std::cos(a)};
  const auto body = set.add({.position = {0, 0, radius},
                             .velocity = {0, v0, 0},
                             .mass = 1.0,
                             .inertia = Mat3(1e9 * Mat3::Identity()),
                             .shape = Sphere{radius}});
  for (long n = std::lround(t / h); n > 0; --n) loop.step(h);
  const double sum = 4.0 / 3 - 2 * g * std::sin(a) * t / v0;
  double tau = 0;  // and is at rest, from 0.52 s on
  for (int n = 0; n < 50 && sum > 0; ++n) tau -= (tau + tau * tau * tau / 3 - sum) / (1 + tau * tau);
  if (tau == 0) REQUIRE(set.velocity(body).norm() <= 1e-9);
  const double downhill = (1.0 / 3 - std::pow(tau, 2) / 2 + std::pow(tau, 6) / 6) / 4;
  const double across = ((1 - std::pow(tau, 3)) / 3 + (1 - std::pow(tau, 5)) / 5) / 2;
  return (set.position(body) - Vec3(way * downhill, way * across, radius)).norm();
}
template <class Integrator>
double off_as_it_slides(double h) {
  return off_on_slope<Integrator>(h, 0.4);
}
template <class Integrator>
double off_where_it_sticks(double h) {
  return off_on_slope<Integrator>(h, 1.2);
}

}  // namespace

// An impact falls at some share of its step, and the error of one run is h times a function of that share,
// with a jump: the slope of one run says nothing. Sixteen shares, the same at every h since 0.45 s are whole
// steps, leave a constant times h. Friction along the velocity at the end of the step errs by its turn.
TEMPLATE_TEST_CASE("impacts are met with first order", "", SymplecticEuler, ImplicitEuler, ImplicitMidpoint) {
  const auto orders = convergence_orders(off_after_bounce<TestType>, 0.01);
  CAPTURE(orders[0], orders[1]);
  CHECK(are_of_order(orders, 1));
}
TEMPLATE_TEST_CASE("sliding and sticking are met with first order", "", SymplecticEuler, ImplicitEuler) {
  for (const auto& orders : {convergence_orders(off_as_it_slides<TestType>, 0.01),
                             convergence_orders(off_where_it_sticks<TestType>, 0.01)}) {
    CAPTURE(orders[0], orders[1]);
    CHECK(are_of_order(orders, 1));
  }
}
// Where it sticks the first of the pairs from 0.01 s on has order 1.84: the asymptote is reached later.
TEST_CASE("sliding and sticking are met with second order by the midpoint rule") {
  for (const auto& orders : {convergence_orders(off_as_it_slides<ImplicitMidpoint>, 0.01),
                             convergence_orders(off_where_it_sticks<ImplicitMidpoint>, 0.005)}) {
    CAPTURE(orders[0], orders[1]);
    CHECK(are_of_order(orders, 2));
  }
}

}  // namespace bouncing_tests
