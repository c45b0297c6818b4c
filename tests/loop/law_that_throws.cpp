// A law of a user's own that throws while it writes its rows: bodies and clock are those of the last whole step, or part of one.
#include <delassus/bodies/rigid_bodies.hpp>
#include <delassus/bodies/world.hpp>
#include <delassus/constraints/constraints.hpp>
#include <delassus/constraints/joints/bilateral.hpp>
#include <delassus/integrators/implicit_midpoint.hpp>
#include <delassus/io/state_hash.hpp>
#include <delassus/loop/animation_loop.hpp>
#include <delassus/schemes/substeps.hpp>
#include <delassus/stabilisation/closed_joints.hpp>
#include <delassus/steppers/newton_midpoint.hpp>
#include <delassus/steppers/rattle.hpp>
#include <delassus/steppers/runge_kutta4.hpp>

#include <stdexcept>
#include <string>

#include "catch.hpp"

namespace law_that_throws_tests {

using namespace delassus;

/// Holds a body at a height, until the countdown of its calls is over; its last row is `row`.
struct Shelf : Bilateral<2> {
  struct Item {
    Anchor a, b;
  };
  int* calls_left = nullptr;
  int row = 1;
  void linearize(const Item& item, const auto& world, auto out) const {
    if ((*calls_left)-- == 0) throw std::runtime_error("the shelf breaks");
    const Vec3 x = world.point(item.a);
    auto end = out.end(item.a, x);
    end.along(0, Vec3(0, 0, 1)), out.phi(0, x[2]);
    end.along(row, Vec3(0, 1, 0)), out.phi(1, x[1]);
  }
};

auto shelf(int* calls_left, int row = 1) {
  Shelf law;
  law.calls_left = calls_left, law.row = row;
  AnimationLoop loop{World{RigidBodies{}}, Constraints{law}, ImplicitMidpoint{}};
  auto& set = bodies<RigidBodies>(loop.world());
  const auto body = set.add({.velocity = {1, 0, 0}, .angular_velocity = {0, 0, 3}, .mass = 1.0, .shape = Box{1, 2, 3}});
  loop.add(Shelf::Item{anchor(set, body), world_anchor({0, 0, 0})});
  return loop;
}

// The midpoint rule asks for the rows of the start and for those at q + h v/2: the second call meets bodies that are moved.
TEST_CASE("a law that throws leaves all bodies in the last good state") {
  for (const int calls : {0, 1}) {
    int calls_left = calls;
    auto loop = shelf(&calls_left);
    const auto& set = bodies<RigidBodies>(loop.world());
    CHECK_THROWS_WITH(loop.step(0.1), "the shelf breaks");
    CHECK(set.position(set.handle(0)) == Vec3(0, 0, 0));
    CHECK(set.orientation(set.handle(0)).coeffs() == Quat::Identity().coeffs());
    CHECK(set.velocity(set.handle(0)) == Vec3(1, 0, 0));
    calls_left = 1000;
    CHECK(loop.step(0.1).status == Status::converged);
  }
}

TEST_CASE("a law that writes a row it has not is refused in a sentence") {
  for (const int row : {-1, 2, 1000000}) {
    int calls_left = 1000;
    auto loop = shelf(&calls_left, row);
    CHECK_THROWS_WITH(loop.step(0.1), "delassus: linearize: a law of 2 rows writes row " + std::to_string(row) +
                                          "; they count from 0 to 1, change its `rows` or its linearize");
  }
}

/// A body that turns about a point beside its middle, one step in and under a force.
auto swing(int* calls_left, auto... policies) {
  Shelf law;
  law.calls_left = calls_left;
  AnimationLoop loop{World{RigidBodies{}}, Constraints{law}, policies...};
  auto& set = bodies<RigidBodies>(loop.world());
  const auto body = set.add({.velocity = {1, 0, 0}, .angular_velocity = {0, 0, 3}, .mass = 1.0, .shape = Box{1, 2, 3}});
  loop.add(Shelf::Item{anchor(set, body, {1, 0, 0}), world_anchor({0, 0, 0})});
  loop.step(0.1);
  set.apply_force(body, {5, 0, 0});
  return loop;
}
/// Throws in each call of a step and makes it again; returns how many calls there are.
int check_taken_back(auto... policies) {
  for (int calls = 0;; ++calls) {
    int left = 1000, other_left = 1000;
    auto loop = swing(&left, policies...), other = swing(&other_left, policies...);
    const auto before = state_hash(loop);
    const double time = loop.time();
    left = calls;
    bool has_thrown = false;
    try {
      loop.step(0.1);
    } catch (const std::runtime_error&) {
      has_thrown = true;
    }
    if (!has_thrown) return calls;
    INFO("call " << calls);
    CHECK(state_hash(loop) == before);
    CHECK(loop.time() == time);
    left = 1000;
    loop.step(0.1), other.step(0.1);
    CHECK(state_hash(loop) == state_hash(other));
  }
}

// The step that is made after it has the bits of a step in which nothing was thrown.
TEST_CASE("a law that throws within a step that is made at once takes all of it back") {
  CHECK(check_taken_back(NewtonMidpoint{}) > 1);
  CHECK(check_taken_back(Rattle{}) > 2);
  CHECK(check_taken_back(Rattle{.drifts = 2}) > 3);
  CHECK(check_taken_back(RungeKutta4{}) > 12);
}

// The first call is that of Linearize. The second finds the gaps where the step has ended, those after it what is left of them: the
// step is then that of a loop which closes no gaps, but for the rounding of a displacement and back.
TEST_CASE("a law that throws as joints are closed leaves the step as it is without that") {
  for (const int calls : {0, 1, 2}) {
    int left = 1000, other_left = 1000;
    auto loop = swing(&left, ClosedJoints{}), other = swing(&other_left, ClosedJoints{});
    other.template policy<role::Stabilisation>().max_passes = 0;
    if (calls > 0) other.step(0.1);
    left = calls;
    CHECK_THROWS_WITH(loop.step(0.1), "the shelf breaks");
    const auto &set = bodies<RigidBodies>(loop.world()), &its = bodies<RigidBodies>(other.world());
    CHECK((set.position(set.handle(0)) - its.position(its.handle(0))).norm() < 1e-14);
    CHECK(set.velocity(set.handle(0)) == its.velocity(its.handle(0)));
    CHECK(loop.time() == other.time());
  }
}

// After two of four parts body and clock are those of two steps of a quarter; the force acts on, over the step that is asked next.
TEST_CASE("a law that throws in a part of a step leaves the parts before it, on the clock too") {
  int left = 1000, other_left = 1000;
  auto loop = swing(&left, Substeps{.count = 4}), other = swing(&other_left, Substeps{.count = 4});
  left = 2;
  CHECK_THROWS_WITH(loop.step(0.1), "the shelf breaks");
  left = 1000;
  other.policy<role::Scheme>().count = 1;
  auto& its = bodies<RigidBodies>(other.world());
  for (int part = 0; part < 2; ++part) {
    other.step(0.1 / 4);
    its.apply_force(its.handle(0), {5, 0, 0});
  }
  CHECK(loop.time() == other.time());
  CHECK(state_hash(loop) == state_hash(other));
  other.policy<role::Scheme>().count = 4;
  loop.step(0.1), other.step(0.1);
  CHECK(loop.time() == other.time());
  CHECK(state_hash(loop) == state_hash(other));
}

}  // namespace law_that_throws_tests
