#include "scenes.hpp"

#include "catch.hpp"

namespace hand_picked_tests {

using namespace scenes;

namespace {

constexpr double h = 1.0 / 60;

auto new_loop() {
  return AnimationLoop{World{RigidBodies{}}, Constraints{Contact{Coulomb{.friction = 0.5}}, BallJoint{}}, HandPicked{}};
}

}  // namespace

TEST_CASE("a body that is off stays, and goes on with its velocity when it is on again") {
  auto loop = new_loop();
  auto& set = rigid_bodies(loop);
  const auto ball = set.add({.position = {0, 0, 5}, .velocity = {1, 0, 2}, .mass = 1.0, .shape = Sphere{0.1}});
  loop.step(h);
  const Vec3 place = set.position(ball), velocity = set.velocity(ball);
  loop.switch_off(ball);
  loop.switch_off(ball);
  for (int n = 0; n < 100; ++n) loop.step(h);
  REQUIRE(set.position(ball) == place);
  REQUIRE(set.velocity(ball) == Vec3(0, 0, 0));
  loop.switch_on(ball);
  loop.switch_on(ball);
  REQUIRE(set.velocity(ball) == velocity);
  loop.step(h);
  REQUIRE((set.velocity(ball) - velocity - Vec3(0, 0, -g * h)).norm() <= 1e-15);
}

TEST_CASE("a force acts in the next step, which a body that is off misses") {
  auto loop = new_loop();
  auto& set = rigid_bodies(loop);
  set.gravity = {0, 0, 0};
  const auto ball = set.add({.mass = 1.0, .shape = Sphere{0.1}});
  loop.switch_off(ball);
  set.apply_force(ball, {60, 0, 0});
  loop.step(h);
  loop.switch_on(ball);
  loop.step(h);
  REQUIRE(set.velocity(ball) == Vec3(0, 0, 0));
  set.apply_force(ball, {60, 0, 0});
  loop.switch_off(ball);
  loop.switch_on(ball);  // no step was missed
  loop.step(h);
  REQUIRE(set.velocity(ball).x() == Approx(1).epsilon(1e-12));
}

TEST_CASE("who is off is an obstacle that no impulse moves") {
  auto loop = new_loop();
  auto& set = rigid_bodies(loop);
  const auto shelf = set.add({.position = {0, 0, 2}, .mass = 1.0, .shape = Box{2, 2, 0.2}});
  const auto box = set.add({.position = {0, 0, 3}, .mass = 50.0, .shape = Box{1, 1, 1}});
  loop.switch_off(shelf);
  StepReport r;
  for (int n = 0; n < 120; ++n) r = loop.step(h);
  REQUIRE(set.position(shelf) == Vec3(0, 0, 2));
  REQUIRE(set.position(box).z() == Approx(2.6).margin(1e-3));
  REQUIRE(r.contacts == 4);
  double held = 0;
  for (const ContactResult& c : loop.contacts()) held += std::abs(c.impulse.z());
  REQUIRE(held == Approx(50 * g * h).epsilon(1e-5));
  loop.switch_on(shelf);
  for (int n = 0; n < 10; ++n) loop.step(h);
  REQUIRE(set.position(shelf).z() < 2);
}

TEST_CASE("between the switched-off there are no pairs and no rows, and a joint to one that is on still holds") {
  auto loop = new_loop();
  auto& set = rigid_bodies(loop);
  set.add_fixed(HalfSpace{});
  std::vector<RigidBodies::Handle> chain;
  Anchor end = world_anchor({0, 0, 5});
  for (int k = 0; k < 4; ++k) {
    chain.push_back(set.add({.position = {0.5 * k + 0.25, 0, 5}, .mass = 1.0, .shape = Box{0.4, 0.1, 0.1}, .collides_with = 0}));
    loop.add(BallJoint::Item{end, anchor(set, chain[k], {-0.25, 0, 0})});
    end = anchor(set, chain[k], {0.25, 0, 0});
  }
  for (int k = 0; k < 3; ++k) loop.switch_off(chain[k]);
  for (int n = 0; n < 20; ++n) {
    const StepReport r = loop.step(h);
    REQUIRE(r.rows == 3);
    REQUIRE(r.pairs == 0);
  }
  REQUIRE(set.position(chain[3]).z() < 5);
  loop.switch_off(chain[3]);
  REQUIRE(loop.step(h).rows == 0);
  loop.wake_all();
  REQUIRE(loop.step(h).rows == 12);
}

TEST_CASE("a body taken out while it is off is gone, and a stale handle is refused") {
  auto loop = new_loop();
  auto& set = rigid_bodies(loop);
  const auto ball = set.add({.position = {0, 0, 5}, .mass = 1.0, .shape = Sphere{0.1}});
  loop.switch_off(ball);
  loop.remove(ball);
  loop.step(h);
  REQUIRE(loop.dormant().bodies().empty());
  REQUIRE_THROWS_WITH(loop.switch_on(ball), Catch::Contains("stale or of another world"));
  const auto next = set.add({.position = {0, 0, 5}, .mass = 1.0, .shape = Sphere{0.1}});
  loop.step(h);
  REQUIRE(set.velocity(next).z() < 0);
}

}  // namespace hand_picked_tests
