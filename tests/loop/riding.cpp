// What rides on a kinematic body stays on it.
#include <delassus/bodies/particles.hpp>
#include <delassus/bodies/rigid_bodies.hpp>
#include <delassus/constraints/contact/contact.hpp>
#include <delassus/constraints/contact/coulomb.hpp>
#include <delassus/constraints/contact/pyramid.hpp>
#include <delassus/constraints/contact/rolling_coulomb.hpp>
#include <delassus/integrators/implicit_euler.hpp>
#include <delassus/integrators/implicit_midpoint.hpp>
#include <delassus/integrators/lie_poisson.hpp>
#include <delassus/loop/animation_loop.hpp>

#include "catch.hpp"

#include <algorithm>
#include <cmath>

namespace riding_tests {

using namespace delassus;

namespace {

constexpr double g = 9.81;

Quat turn(const Vec3& axis, double angle) { return exponential<double>(Vec3(angle * axis)); }

auto scene(auto law, auto... policies) {
  return AnimationLoop{World{RigidBodies{}}, Constraints{Contact{law}}, policies...};
}
RigidBodies& set_of(auto& loop) { return bodies<RigidBodies>(loop.world()); }
auto add_table(RigidBodies& set, double radius = 2) {
  return set.add({.position = {0, 0, -0.05}, .shape = Cylinder{radius, 0.1}, .motion = Motion::kinematic});
}
/// A cube of 20 cm on the table, at x = 1 m, that goes with its turn.
auto add_rider(RigidBodies& set, double rate) {
  return set.add({.position = {1, 0, 0.1}, .velocity = {0, rate, 0}, .angular_velocity = {0, 0, rate}, .mass = 1.0, .shape = Box{0.2, 0.2, 0.2}});
}
/// Where `rider` is in the frame of `carrier`, m.
Vec3 place_on(const RigidBodies& set, RigidBodies::Handle carrier, RigidBodies::Handle rider) {
  return set.orientation(carrier).conjugate() * Vec3(set.position(rider) - set.position(carrier));
}

enum class Led { by_velocity, by_move_to };

/// How far a cube has gone on a table that turned at 1 rad/s for 20 s, m.
double slip(Led led, double h, auto law, auto... policies) {
  auto loop = scene(law, policies...);
  auto& set = set_of(loop);
  const auto table = add_table(set), rider = add_rider(set, 1);
  const Vec3 start = place_on(set, table, rider);
  if (led == Led::by_velocity) set.set_velocity(table, Vec3::Zero(), {0, 0, 1});
  for (int n = 1; n <= std::lround(20 / h); ++n) {
    if (led == Led::by_move_to) set.move_to(table, {0, 0, -0.05}, turn({0, 0, 1}, n * h));
    loop.step(h);
  }
  return (place_on(set, table, rider) - start).norm();
}
/// μ of which a rider at 1 m and 1 rad/s needs this share: ω² r = share μ g.
double friction_of(double share) { return 1 / (share * g); }

}  // namespace

// A rider sticks while ω² r < μ g, and then stays: d = 0. What each solve leaves, 1e-6 of h g, adds up over N steps like a random
// walk at most to h · 1e-6 h g √N = 1e-7 m at 1/60 s.
TEST_CASE("a box on a turntable stays where it is up to the limit of its friction") {
  for (const double h : {1.0 / 60, 1.0 / 240})
    for (const double share : {0.2, 0.95}) {
      CAPTURE(h, share);
      CHECK(slip(Led::by_velocity, h, Coulomb{.friction = friction_of(share)}) <= 1e-6);
    }
  CHECK(slip(Led::by_move_to, 1.0 / 60, Coulomb{.friction = friction_of(0.95)}) <= 1e-6);
  CHECK(slip(Led::by_velocity, 1.0 / 60, Coulomb{.friction = friction_of(1.02)}) >= 0.5);
}

TEST_CASE("a box stays on a turntable under every law of friction and every integrator of the stages") {
  const double h = 1.0 / 60, mu = friction_of(0.5);
  CHECK(slip(Led::by_velocity, h, Pyramid{.friction = mu}) <= 1e-6);
  CHECK(slip(Led::by_velocity, h, RollingCoulomb{.friction = mu, .rolling_friction = 1e-3, .torsional_friction = 1e-3}) <= 1e-6);
  CHECK(slip(Led::by_velocity, h, Coulomb{.friction = mu}, ImplicitEuler{}) <= 1e-6);
  CHECK(slip(Led::by_velocity, h, Coulomb{.friction = mu}, LiePoisson{}) <= 1e-6);
  CHECK(slip(Led::by_velocity, h, Coulomb{.friction = mu}, ImplicitMidpoint{}) <= 1e-6);
}

TEST_CASE("a box on a box on a turntable keeps its place on it") {
  auto loop = scene(Coulomb{.friction = 0.6});
  auto& set = set_of(loop);
  const auto table = add_table(set), lower = add_rider(set, 1);
  const auto upper = set.add({.position = {1.05, 0, 0.25}, .velocity = {0, 1.05, 0}, .angular_velocity = {0, 0, 1}, .mass = 1.0, .shape = Box{0.1, 0.1, 0.1}});
  const Vec3 start = place_on(set, lower, upper);
  set.set_velocity(table, Vec3::Zero(), {0, 0, 1});
  for (int n = 0; n < 1200; ++n) loop.step(1.0 / 60);
  CHECK((place_on(set, lower, upper) - start).norm() <= 1e-6);
}

// v̇ = 2/7 Ω × v of a homogeneous ball that rolls on a table: a circle at 2/7 of the table's rate, whatever its speed and place.
// U of the start of a step would make the speed grow by 2/49 h Ω² a second, its chord make it shrink by 5/49 h Ω²: 5 and 13 % here.
TEST_CASE("a ball on a turntable keeps the speed of its circle, and on a plank that rides on it") {
  for (const bool has_plank : {false, true}) {
    CAPTURE(has_plank);
    auto loop = scene(Coulomb{.friction = 1});
    auto& set = set_of(loop);
    const double rate = 2, radius = 0.1, h = 1.0 / 60, floor = has_plank ? 0.1 : 0;
    const auto table = add_table(set);
    if (has_plank) set.add({.position = {0, 0, 0.05}, .angular_velocity = {0, 0, rate}, .mass = 1000.0, .shape = Box{3, 3, 0.1}});
    const auto ball = set.add({.position = {0, 0, floor + radius}, .velocity = {0.3, 0, 0}, .angular_velocity = {0, 0.3 / radius, 0}, .mass = 1.0, .shape = Sphere{radius}});
    set.set_velocity(table, Vec3::Zero(), {0, 0, rate});
    double turned = 0;
    Vec3 last = set.velocity(ball);
    for (int n = 0; n < 1200; ++n) {
      loop.step(h);
      const Vec3 v = set.velocity(ball);
      turned += std::atan2(last.cross(v).z(), last.dot(v));
      last = v;
    }
    CHECK(last.norm() == Approx(0.3).epsilon(1e-3));
    CHECK(turned == Approx(2.0 / 7 * rate * 20).epsilon(1e-3));
  }
}

// The table turns about its middle by 0.4 rad, which tan 0.4 = 0.42 < μ holds.
TEST_CASE("a table that tilts gently carries a box") {
  auto loop = scene(Coulomb{.friction = 0.6});
  auto& set = set_of(loop);
  const double h = 1.0 / 60, rate = 0.05;
  const auto table = set.add({.position = {0, 0, -0.05}, .shape = Box{4, 4, 0.1}, .motion = Motion::kinematic}), rider = add_rider(set, 0);
  loop.step(h);
  const Vec3 start = place_on(set, table, rider);
  for (int n = 1; n <= 480; ++n) {
    set.move_to(table, turn({0, 1, 0}, n * h * rate) * Vec3(0, 0, -0.05), turn({0, 1, 0}, n * h * rate));
    loop.step(h);
  }
  CHECK((place_on(set, table, rider) - start).norm() <= 1e-4);
}

// A tower of two on a cube that swings by 0.3 rad about an axis that leans, off its middle. At its start a step sees the rates of
// the one before: (h ω)² of the way between the middles, 0.6 m, at 0.3 rad/s, is 2e-5 m, and goes to and fro.
TEST_CASE("what stands on a cube that swings stays there") {
  auto loop = scene(Coulomb{.friction = 2});
  auto& set = set_of(loop);
  const double h = 1.0 / 60;
  const auto cube = set.add({.shape = Box{1, 1, 1}, .motion = Motion::kinematic});
  const auto lower = set.add({.position = {0.3, 0, 0.6}, .mass = 1.0, .shape = Box{0.2, 0.2, 0.2}});
  const auto upper = set.add({.position = {0.3, 0.03, 0.75}, .mass = 1.0, .shape = Box{0.1, 0.1, 0.1}});
  const Vec3 start = place_on(set, cube, lower), above = place_on(set, lower, upper);
  double far = 0;
  for (int n = 1; n <= 600; ++n) {
    set.move_to(cube, Vec3::Zero(), turn(Vec3(1, 0.3, 0), 0.15 * (1 - std::cos(2 * n * h))));
    loop.step(h);
    far = std::max({far, (place_on(set, cube, lower) - start).norm(), (place_on(set, lower, upper) - above).norm()});
  }
  CHECK(far <= 2e-5);
}

// A particle has no turn of its own; ω³ h²/12 … of the circle are left, 5 · 1e-6 m a second.
TEST_CASE("a particle on a turntable stays on its circle") {
  AnimationLoop loop{World{RigidBodies{}, Particles{}}, Constraints{Contact{Coulomb{.friction = 0.5}}}};
  auto& dust = bodies<Particles>(loop.world());
  const auto table = add_table(set_of(loop));
  const auto grain = dust.add({.position = {1, 0, 0.02}, .velocity = {0, 1, 0}, .mass = 1.0, .radius = 0.02});
  set_of(loop).set_velocity(table, Vec3::Zero(), {0, 0, 1});
  for (int n = 0; n < 1200; ++n) loop.step(1.0 / 60);
  CHECK(std::hypot(dust.position(grain).x(), dust.position(grain).y()) == Approx(1).margin(1e-4));
}

// Rollers turn under the plank; no point of it goes round with them.
TEST_CASE("a plank on rollers goes at their speed") {
  auto loop = scene(Coulomb{.friction = 0.5});
  auto& set = set_of(loop);
  const double radius = 0.1, rate = 10;
  for (int i = 0; i < 8; ++i) {
    const auto roller = set.add({.position = {0.4 * i, 0, -radius}, .shape = Sphere{radius}, .motion = Motion::kinematic});
    const auto other = set.add({.position = {0.4 * i, 0.5, -radius}, .shape = Sphere{radius}, .motion = Motion::kinematic});
    for (const auto each : {roller, other}) set.set_velocity(each, Vec3::Zero(), {0, rate, 0});
  }
  const auto plank = set.add({.position = {0.5, 0.25, 0.05}, .mass = 1.0, .shape = Box{1.4, 0.8, 0.1}});
  for (int n = 0; n < 60; ++n) loop.step(1.0 / 60);
  CHECK(set.velocity(plank).x() == Approx(radius * rate).epsilon(1e-4));
}

}  // namespace riding_tests
