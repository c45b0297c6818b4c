#include "scenes.hpp"

#include "catch.hpp"

namespace penalty_tests {

using namespace scenes;

namespace {

constexpr double h = 1.0 / 60;

template <class... Parts>
auto loop_with(double stiffness, double damping, Parts... parts) {
  return AnimationLoop{World{RigidBodies{}}, Constraints{Contact{Penalty{Coulomb{.friction = 0.5}, stiffness, damping}}},
                       AcceleratedGaussSeidel{.tolerance = 1e-10}, parts...};
}

/// A ball of 1 kg and radius 0.5 m with its centre at `height` above the ground; its sag after `steps` steps of `step` s.
template <class Loop>
double sag(Loop loop, double step, int steps, double height = 0.5) {
  auto& set = rigid_bodies(loop);
  set.add_fixed(HalfSpace{});
  const auto ball = set.add({.position = {0, 0, height}, .mass = 1.0, .shape = Sphere{0.5}});
  for (int n = 0; n < steps; ++n) loop.step(step);
  return 0.5 - set.position(ball).z();
}

/// Kinetic and potential energy, and what the springs of the contacts hold; J.
template <class Loop>
double energy(Loop& loop, double stiffness, double floor_z = 0) {
  auto& set = rigid_bodies(loop);
  double e = 0;
  for (const Index b : set.active()) {
    if (!set.moves(b)) continue;
    const auto body = set.handle(b);
    e += set.mass(b) * (0.5 * set.velocity(body).template head<3>().squaredNorm() + g * set.position(body).z());
    const double depth = floor_z + 0.5 - set.position(body).z();
    if (depth > 0) e += 0.5 * stiffness * depth * depth;
  }
  return e;
}

}  // namespace

TEST_CASE("a ball on a penalty contact sags by its weight over the stiffness, whatever way the spring acts") {
  for (const double k : {1e3, 1e6}) {
    const double expected = g / k, critical = 2 * std::sqrt(k);
    CAPTURE(k);
    // The last impact leaves exp(−t ω) of itself: 20 s at ω ≥ 30 1/s are plenty for 1e-6.
    CHECK(sag(loop_with(k, critical), h, 1200) == Approx(expected).epsilon(1e-6));
    CHECK(sag(loop_with(k, critical, ImplicitEuler{}, CollisionsFirst{}), h, 1200) == Approx(expected).epsilon(1e-6));
    // As an explicit force only where h √(k/m) < 2; with critical damping h c/m < 2 asks for a quarter of that.
    const double small = 0.1 / std::sqrt(k);
    CHECK(sag(loop_with(k, critical, CollisionsFirst{}), small, 4000) == Approx(expected).epsilon(1e-6));
  }
}

TEST_CASE("as a force of the free motion a penalty contact has no row and still tells its impulse") {
  auto loop = loop_with(1e3, 60, CollisionsFirst{});
  auto& set = rigid_bodies(loop);
  set.add_fixed(HalfSpace{});
  set.add({.position = {0, 0, 0.5}, .mass = 1.0, .shape = Sphere{0.5}});
  StepReport r;
  for (int n = 0; n < 2000; ++n) r = loop.step(1e-3);
  REQUIRE(r.contacts == 1);
  REQUIRE(r.rows == 0);
  REQUIRE(loop.contacts()[0].impulse.z() == Approx(g * 1e-3).epsilon(1e-6));
}

TEST_CASE("a ball sags on its spring beside projected positions, which are for rigid contacts") {
  for (const double k : {1e3, 1e6})
    CHECK(sag(loop_with(k, 2 * std::sqrt(k), PositionProjection{}), h, 1200) == Approx(g / k).epsilon(1e-6));
}

// Implicit Euler of a convex spring never adds energy; gravity acts with the velocity after the step, which adds none either:
// the sum may rise by rounding only, 1e-15 of its 15 J a step.
TEST_CASE("a penalty contact of 1e6 N/m is stable at 1/60 s, and the energy never grows") {
  for (const double damping : {0.0, 100.0}) {
    auto loop = loop_with(1e6, damping, ImplicitEuler{}, CollisionsFirst{});
    auto& set = rigid_bodies(loop);
    set.add_fixed(HalfSpace{});
    const auto ball = set.add({.position = {0, 0, 1.5}, .mass = 1.0, .shape = Sphere{0.5}});
    double last = energy(loop, 1e6);
    for (int n = 0; n < 2000; ++n) {
      loop.step(h);
      const double now = energy(loop, 1e6);
      REQUIRE(now <= last + 1e-14 * 15);
      last = now;
    }
    REQUIRE(0.5 - set.position(ball).z() == Approx(g / 1e6).epsilon(1e-6));
  }
}

TEST_CASE("ten boxes stacked on springs of 1e6 N/m come to rest and stay") {
  auto loop = loop_with(1e6, 1e3, ImplicitEuler{}, CollisionsFirst{});
  const auto boxes = add_stack(rigid_bodies(loop), 10, Box{1, 1, 1});
  for (int n = 0; n < 1200; ++n) loop.step(h);
  // Four springs under box k carry the 10 − k boxes above them and itself: the top sinks by Σ (10 − k) g/4e6.
  REQUIRE(9.5 - rigid_bodies(loop).position(boxes[9]).z() == Approx(55 * g / 4e6).epsilon(1e-4));
  REQUIRE(rigid_bodies(loop).velocity(boxes[9]).norm() <= 1e-7);
}

TEST_CASE("one penalty contact is implicit Euler's damped spring in closed form") {
  const double k = 5e3, c = 20, m = 1;
  auto loop = loop_with(k, c, ImplicitEuler{}, CollisionsFirst{});
  auto& set = rigid_bodies(loop);
  set.add_fixed(HalfSpace{});
  const auto ball = set.add({.position = {0, 0, 0.49}, .mass = m, .shape = Sphere{0.5}});
  double x = -0.01, v = 0;
  for (int n = 0; n < 20 && x < 0; ++n) {
    // (m + h c + h² k) v⁺ = m v − h m g − h k x, while the spring pushes.
    const double next = (m * v - h * m * g - h * k * x) / (m + h * c + h * h * k);
    if (k * (-x - h * next) - c * next < 0) break;
    v = next;
    x += h * v;
    loop.step(h);
    REQUIRE(set.position(ball).z() - 0.5 == Approx(x).margin(1e-11));
  }
  REQUIRE(x != -0.01);
}

TEST_CASE("as a force and as a row the spring is the same to first order in the step") {
  double last = 0;
  for (const int steps : {200, 400, 800}) {
    const double step = 0.2 / steps;
    const double error = std::abs(sag(loop_with(2e3, 10, CollisionsFirst{}), step, steps, 0.52) -
                                  sag(loop_with(2e3, 10), step, steps, 0.52));
    if (last > 0) REQUIRE(error / last == Approx(0.5).margin(0.1));
    last = error;
  }
}

TEST_CASE("a block slides on penalty contacts with mu g, and friction as a force stops it without turning it round") {
  auto loop = loop_with(1e4, 100, CollisionsFirst{});
  auto& set = rigid_bodies(loop);
  set.add_fixed(HalfSpace{});
  const double step = 1e-3;
  const auto block = set.add({.position = {0, 0, 0.25 - g / 4e4}, .velocity = {2, 0, 0}, .mass = 1.0, .shape = Box{2, 2, 0.5}});
  for (int n = 0; n < 200; ++n) loop.step(step);
  REQUIRE(set.velocity(block)[0] == Approx(2 - 0.5 * g * 0.2).epsilon(1e-3));
  double least = 1;
  for (int n = 0; n < 600; ++n) {
    loop.step(step);
    least = std::min(least, set.velocity(block)[0]);
  }
  // Four contacts stop it together, each as if alone: the last step may turn a quarter of μ g h round.
  REQUIRE(least >= -0.5 * g * step);
  REQUIRE(std::abs(set.velocity(block)[0]) <= 0.5 * g * step);
}

TEST_CASE("two bodies that push each other apart keep their momentum and angular momentum") {
  auto loop = loop_with(1e4, 10, CollisionsFirst{});
  auto& set = rigid_bodies(loop);
  set.gravity.setZero();
  const auto a = set.add({.position = {0, 0, 0}, .angular_velocity = {0, 3, 8}, .mass = 1.0, .shape = Sphere{0.5}});
  const auto b = set.add({.position = {0.9, 0.3, 0}, .velocity = {-1, 0, 0}, .mass = 3.0, .shape = Sphere{0.5}});
  const Vec3 p = momentum(set), L = angular_momentum(set);
  for (int n = 0; n < 200; ++n) loop.step(1e-3);
  REQUIRE((set.position(b) - set.position(a)).norm() > 1);
  REQUIRE(std::abs(set.angular_velocity(b).z()) > 0.1);  // friction has turned it
  REQUIRE((momentum(set) - p).norm() <= 1e-14 * 10);
  REQUIRE((angular_momentum(set) - L).norm() <= 1e-13 * 10);
}

namespace {
struct OnRubber {
  static bool takes(Index a, Index b) { return a == 1 || b == 1; }
};
}  // namespace

TEST_CASE("penalty and rigid contacts stand side by side, by their materials") {
  AnimationLoop loop{World{RigidBodies{}},
                     Constraints{ContactFor<Penalty<Coulomb>, OnRubber>{{Penalty{Coulomb{.friction = 0.5}, 1e3, 60}}},
                                 Contact{Coulomb{.friction = 0.5}}},
                     AcceleratedGaussSeidel{.tolerance = 1e-10}, CollisionsFirst{}};
  const Index rubber = loop.materials().add({.friction = 0.5});
  REQUIRE(rubber == 1);
  auto& set = rigid_bodies(loop);
  set.add_fixed(HalfSpace{});
  const auto hard = set.add({.position = {0, 0, 0.5}, .mass = 1.0, .shape = Sphere{0.5}});
  const auto soft = set.add({.position = {3, 0, 0.5}, .mass = 1.0, .shape = Sphere{0.5}, .material = rubber});
  StepReport r;
  for (int n = 0; n < 3000; ++n) r = loop.step(1e-3);
  REQUIRE(r.contacts == 2);
  REQUIRE(r.rows == 3);
  REQUIRE(std::abs(set.position(hard).z() - 0.5) <= 1e-9);
  REQUIRE(0.5 - set.position(soft).z() == Approx(g / 1e3).epsilon(1e-6));
}

TEST_CASE("a stiffness that is not above zero and a damping below zero are refused") {
  REQUIRE_THROWS_WITH(loop_with(0, 1), "delassus: Penalty: stiffness 0 N/m must be finite and > 0");
  REQUIRE_THROWS_WITH(loop_with(std::nan(""), 1), Catch::Contains("Penalty: stiffness"));
  REQUIRE_THROWS_WITH(loop_with(1, -2), Catch::Contains("Penalty: damping -2"));
}

// At rest a spring of each contact point bears its share of the weight: m g/k deep for a ball, m g/(4 k) for a box. Two materials are
// two springs one behind the other.
TEST_CASE("materials say how stiff a pair is, and bodies sink by their weight over it") {
  AnimationLoop loop{World{RigidBodies{}}, Constraints{Contact{Penalty{Coulomb{.friction = 0.5}, 1e6, 1e3}}}};
  auto& set = rigid_bodies(loop);
  const Index rubber = loop.materials().add({.stiffness = 6e3, .damping = 600});
  const Index steel = loop.materials().add({.stiffness = 3e4, .damping = 3e3});
  const Index wood = loop.materials().add({});
  loop.materials().set_pair(wood, rubber, {.stiffness = 2e3, .damping = 200});
  set.add({.shape = HalfSpace{}, .motion = Motion::fixed, .material = rubber});
  const auto add = [&](double x, const Shape& shape, Index material) {
    return set.add({.position = {x, 0, 0.5}, .mass = 2.0, .shape = shape, .material = material});
  };
  const auto soft = add(0, Sphere{0.5}, rubber), hard = add(2, Sphere{0.5}, steel), box = add(4, Box{1, 1, 1}, steel),
             pair = add(6, Sphere{0.5}, wood), plain = add(8, Sphere{0.5}, 0);
  for (int n = 0; n < 600; ++n) REQUIRE(loop.step(h).status == Status::converged);
  const auto depth = [&](auto body) { return 0.5 - set.position(body).z(); };
  CHECK(depth(soft) == Approx(2 * g / 3e3).epsilon(1e-6));
  CHECK(depth(hard) == Approx(2 * g / 5e3).epsilon(1e-6));
  CHECK(depth(box) == Approx(2 * g / 2e4).epsilon(1e-6));
  CHECK(depth(pair) == Approx(2 * g / 2e3).epsilon(1e-6));
  CHECK(depth(plain) == Approx(2 * g / 1e6).epsilon(1e-6));
}

TEST_CASE("a material with a damper and no spring, or less than none, is refused") {
  auto loop = loop_with(1e5, 10);
  REQUIRE_THROWS_WITH(loop.materials().add({.damping = 10}), Catch::Contains("material: damping 10 needs a stiffness > 0 beside it"));
  REQUIRE_THROWS_WITH(loop.materials().add({.stiffness = -1}), Catch::Contains("material: stiffness -1"));
  REQUIRE_THROWS_WITH(loop.materials().set_pair(0, 0, {.stiffness = std::nan("")}), Catch::Contains("material pair: stiffness"));
}

}  // namespace penalty_tests
