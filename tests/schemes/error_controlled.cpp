// Steps whose size follows the error that is asked for.
#include <delassus/io/checkpoint.hpp>
#include <delassus/schemes/error_controlled.hpp>

#include "scenes.hpp"
#include "true_error.hpp"

#include <cmath>
#include <stdexcept>
#include <string>
#include <vector>

#include "catch.hpp"

namespace error_controlled_tests {

using namespace scenes;
using namespace true_error;

namespace {

template <class Integrator = ImplicitMidpoint>
auto bouncing(double accuracy) {
  AnimationLoop loop{World{RigidBodies{}}, Constraints{Contact{Restitution{Coulomb{.friction = 0.5}, 0.8}}}, Integrator{}, PositionProjection{},
                     AcceleratedGaussSeidel{.tolerance = 1e-9}, ErrorControlled{.accuracy = accuracy}};
  auto& set = rigid_bodies(loop);
  set.add_fixed(HalfSpace{});
  set.add({.position = {0, 0, 1.1}, .mass = 1, .shape = Sphere{0.1}});
  return loop;
}
/// Height above the ground of a ball let fall from 1 m, e = 0.8; 0 once it rests.
double height_of_bounces(double t) {
  double v = std::sqrt(2 * g), start = -v / g;  // as if it had come up from the ground
  while (v > 1e-7 && t >= start + 2 * v / g) start += 2 * v / g, v *= 0.8;
  return v > 1e-7 ? v * (t - start) - g / 2 * (t - start) * (t - start) : 0;
}

/// Throws when it is asked for the eighth time.
struct Throws {
  using plays = role::Listener;
  using listens = Listens<>;
  int left = 8;
  void lead(auto&, double, double) {
    if (--left == 0) throw std::runtime_error("nobody leads");
  }
};

/// Counts the parts that it hears of.
struct Heard {
  using plays = role::Listener;
  using listens = Listens<stage::Advance, stage::Step>;
  long parts = 0, steps = 0;
  std::vector<double> times{};
  void after(stage::Advance, const auto& step) { ++parts, times.push_back(step.time()); }
  void after(stage::Step, const auto&) { ++steps; }
};

}  // namespace

// A top about its middle axis turns over and over. The reference is the same at an accuracy a thousand times finer.
TEST_CASE("the error of a spinning top follows the accuracy") {
  const auto top = [](double accuracy) {
    AnimationLoop loop{World{RigidBodies{}}, ImplicitMidpoint{}, ErrorControlled{.accuracy = accuracy, .max_step = 1}};
    auto& set = rigid_bodies(loop);
    set.gravity.setZero();
    const Mat3 inertia = Vec3(1, 2, 3).asDiagonal();
    const auto body = set.add({.angular_velocity = {0.01, 5, 0.01}, .mass = 1, .inertia = inertia});
    for (int i = 0; i < 5; ++i) loop.step(1);
    return set.orientation(body);
  };
  const Quat reference = top(1e-8);
  follows([&](double accuracy) { return top(accuracy).angularDistance(reference); }, 0.1, 10);
}

// The largest error at all tenths of a second, in radii: bounces without end come to rest after 9 √(2/g) = 4.06 s.
TEST_CASE("the error of a bouncing ball follows the accuracy, and it rests in time") {
  const auto error = [](auto loop) {
    double worst = 0;
    Work work;
    for (int i = 1; i <= 45; ++i) {
      loop.step(0.1);
      work.add(error_report(loop));
      worst = std::max(worst, std::abs(rigid_bodies(loop).pose(1).position.z() - 0.1 - height_of_bounces(0.1 * i)) / 0.1);
    }
    CHECK(work.at_floor == 0);
    CHECK(rigid_bodies(loop).velocity()[1].norm() < 1e-6);
    return worst;
  };
  follows([&](double accuracy) { return error(bouncing(accuracy)); }, 0.1, 10);
  // By Euler's rule a step and its halves can make the same bounce too early, which only the gap tells.
  CHECK(error(bouncing<SymplecticEuler>(1e-2)) <= 10 * 1e-2);
}

TEST_CASE("a stack at rest takes the largest step from the tenth on, and none twice") {
  AnimationLoop loop{World{RigidBodies{}}, Constraints{Contact{Coulomb{.friction = 0.5}}}, ImplicitMidpoint{}, PositionProjection{}, ErrorControlled{}};
  add_stack(rigid_bodies(loop), 5, Box{1, 1, 1}, 0);
  Work work;
  for (int i = 0; i < 60; ++i) loop.step(1), work.add(error_report(loop));
  CHECK(work.rejections == 0);
  CHECK(work.steps <= 610);
  CHECK(error_report(loop).last_step == Approx(0.1).epsilon(1e-9));
}

TEST_CASE("what a step tried and gave up leaves no trace") {
  auto loop = bouncing(1e-4);
  for (int i = 0; i < 4; ++i) loop.step(0.1);
  const std::vector<char> before = checkpoint(loop);
  inner::StepCopy copy;
  copy.keep(loop.data());
  auto& step = loop.data();
  step.h = 0.07;
  stage::detect(step);
  stage::move(step);
  REQUIRE(checkpoint(loop) != before);
  copy.bring_back(step);
  CHECK(checkpoint(loop) == before);
}

TEST_CASE("runs under error control repeat to the bit, from the start and from a checkpoint") {
  auto loop = bouncing(1e-4), other = bouncing(1e-4);
  for (int i = 0; i < 7; ++i) loop.step(0.1), other.step(0.1);
  auto restored = bouncing(1e-4);
  restore(restored, checkpoint(loop));
  for (int i = 0; i < 13; ++i) {
    loop.step(0.1), other.step(0.1), restored.step(0.1);
    REQUIRE(state_hash(loop) == state_hash(other));
    REQUIRE(state_hash(loop) == state_hash(restored));
    REQUIRE(error_report(loop).steps == error_report(restored).steps);
  }
}

TEST_CASE("loads act over the whole step, led bodies arrive at its end, impulses are those of all of it") {
  AnimationLoop loop{World{RigidBodies{}}, Constraints{Contact{Coulomb{.friction = 0.5}}}, ImplicitMidpoint{}, PositionProjection{}, ErrorControlled{}};
  auto& set = rigid_bodies(loop);
  set.add_fixed(HalfSpace{});
  const auto block = set.add({.position = {0, 0, 0.5}, .mass = 2, .shape = Box{1, 1, 1}});
  const auto carried = set.add({.position = {9, 0, 5}, .motion = Motion::kinematic});
  set.move_to(carried, {9, 1, 5});
  set.apply_force(block, {0, 0, -5});
  loop.step(0.5);
  double sum = 0;
  for (const ContactResult& contact : loop.contacts()) sum += contact.impulse.z();
  CHECK(std::abs(sum) == Approx((2 * g + 5) * 0.5).epsilon(1e-5));
  CHECK(set.position(carried) == Vec3(9, 1, 5));
  CHECK(loop.time() == 0.5);
  loop.step(0.5);
  sum = 0;
  for (const ContactResult& contact : loop.contacts()) sum += contact.impulse.z();
  CHECK(std::abs(sum) == Approx(2 * g * 0.5).epsilon(1e-5));  // the load acted once
}

TEST_CASE("listeners hear accepted steps alone, and these end at each output") {
  AnimationLoop loop{World{RigidBodies{}}, Constraints{Contact{Restitution{Frictionless{}, 0.8}}}, ImplicitMidpoint{}, PositionProjection{}, Heard{},
                     ErrorControlled{.output_step = 0.03}};
  auto& set = rigid_bodies(loop);
  set.add_fixed(HalfSpace{});
  set.add({.position = {0, 0, 0.6}, .mass = 1, .shape = Sphere{0.1}});
  Work work;
  for (int i = 0; i < 6; ++i) loop.step(0.25), work.add(error_report(loop));
  const auto& heard = loop.data().get<Heard>();
  CHECK(work.rejections > 0);
  CHECK(heard.steps == 6);
  CHECK(heard.parts == work.steps);
  for (int k = 1; k * 0.03 <= 1.5 + 1e-9; ++k) {
    double nearest = 1;
    for (const double t : heard.times) nearest = std::min(nearest, std::abs(t - 0.03 * k));
    CHECK(nearest < 1e-12);
  }
}

// In flight the middle of the step is exact: z = ½ g t².
TEST_CASE("what is thrown within a step leaves the bodies at the end of an inner step") {
  AnimationLoop loop{World{RigidBodies{}}, Constraints{Contact{Frictionless{}}}, ImplicitMidpoint{}, PositionProjection{}, Throws{}, ErrorControlled{}};
  auto& set = rigid_bodies(loop);
  const auto ball = set.add({.mass = 1, .shape = Sphere{0.1}});
  CHECK_THROWS_WITH(loop.step(0.1), "nobody leads");
  CHECK(loop.time() > 0);
  CHECK(std::abs(set.position(ball).z() + g / 2 * loop.time() * loop.time()) < 1e-12);
  loop.step(0.1);
  CHECK(std::abs(set.position(ball).z() + g / 2 * loop.time() * loop.time()) < 1e-12);
}

TEST_CASE("the report names the body and what its error is made by") {
  auto loop = bouncing(1e-3);
  while (loop.time() < 0.39) loop.step(0.1);
  CHECK(error_report(loop).effect == ErrorEffect::motion);
  loop.step(0.1);  // it strikes after √(2/g) = 0.45 s
  CHECK(error_report(loop).effect == ErrorEffect::impact);
  CHECK(error_report(loop).set == 0);
  CHECK(error_report(loop).block == 1);
  CHECK(error_report(loop).rejections > 0);
  CHECK(error_report(loop).error <= 1e-3);
}

TEST_CASE("numbers of ErrorControlled that cannot be are one sentence") {
  const auto step = [](const ErrorControlled& asked, double tolerance = 1e-9) {
    AnimationLoop loop{World{RigidBodies{}}, Constraints{Contact{Frictionless{}}}, ImplicitMidpoint{}, AcceleratedGaussSeidel{.tolerance = tolerance},
                       ErrorControlled{asked}};
    rigid_bodies(loop).add({.mass = 1, .shape = Sphere{0.1}});
    loop.step(0.01);
  };
  CHECK_THROWS_WITH(step({.accuracy = 0}), Catch::Contains("ErrorControlled: accuracy"));
  CHECK_THROWS_WITH(step({.accuracy = 0.2}), Catch::Contains("ErrorControlled: accuracy"));
  CHECK_THROWS_WITH(step({.min_step = 1, .max_step = 0.1}), Catch::Contains("min_step"));
  CHECK_THROWS_WITH(step({.max_step = -1}), Catch::Contains("max_step"));
  CHECK_THROWS_WITH(step({.accuracy = 1e-6}, 1e-6), Catch::Contains("the solver's tolerance"));
  AnimationLoop euler{World{RigidBodies{}}, ErrorControlled{.accuracy = 1e-4}};
  rigid_bodies(euler).add({.mass = 1, .shape = Sphere{0.1}});
  CHECK_THROWS_WITH(euler.step(0.01), Catch::Contains("first order"));
}

}  // namespace error_controlled_tests
