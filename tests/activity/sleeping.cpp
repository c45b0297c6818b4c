#include "scenes.hpp"

#include <delassus/bodies/bounds.hpp>
#include <delassus/io/checkpoint.hpp>

#include <array>
#include <functional>
#include <utility>

#include "catch.hpp"

namespace sleeping_tests {

using namespace scenes;

namespace {

constexpr double h = 1.0 / 60;

template <class Activity>
auto loop_with(Activity activity) {
  return AnimationLoop{World{RigidBodies{}}, Constraints{Contact{Coulomb{.friction = 0.5}}, BallJoint{}, DistanceJoint{}},
                       AcceleratedGaussSeidel{.tolerance = 1e-8}, activity};
}

/// A stack of three that has fallen asleep, on a floor that can be moved and taken away.
struct Asleep {
  decltype(loop_with(Sleeping{})) loop = loop_with(Sleeping{});
  RigidBodies::Handle floor;
  std::vector<RigidBodies::Handle> stack;

  Asleep() {
    auto& set = rigid_bodies(loop);
    floor = set.add({.position = {0, 0, -0.5}, .shape = Box{20, 20, 1}, .motion = Motion::kinematic});
    for (int k = 0; k < 3; ++k) stack.push_back(set.add({.position = {0, 0, 0.5 + k}, .mass = 1.0, .shape = Box{1, 1, 1}}));
    run(60);
    REQUIRE(sleepers() == 3);
  }
  Asleep(const Asleep&) = delete;
  auto& set() { return rigid_bodies(loop); }
  std::size_t sleepers() const { return loop.dormant().bodies().size(); }
  StepReport run(int steps) {
    StepReport r;
    for (int n = 0; n < steps; ++n) r = loop.step(h);
    return r;
  }
};

/// Does `what` once, after stage S.
template <class S>
struct After {
  using plays = role::Listener;
  using listens = Listens<S>;
  std::function<void()> what;
  void after(S, const auto&) {
    if (const auto once = std::exchange(what, nullptr)) once();
  }
};

/// The speed (m/s) at which a ball falls after a step in which its joint is taken out after stage S, and after one more.
template <class S>
std::array<double, 2> speeds_of_let_go() {
  AnimationLoop loop{World{RigidBodies{}}, Constraints{BallJoint{}}, Sleeping{}, After<S>{}};
  auto& set = rigid_bodies(loop);
  const auto ball = set.add({.mass = 1, .shape = Sphere{0.1}});
  const auto hook = loop.add(BallJoint::Item{world_anchor({0, 0, 0}), anchor(set, ball)});
  loop.template get<After<S>>().what = [&] { loop.remove(hook); };
  std::array<double, 2> speeds{};
  for (double& speed : speeds) {
    loop.step(h);
    speed = -set.velocity(ball).z();
  }
  return speeds;
}

}  // namespace

TEST_CASE("a joint that a listener takes out within a step lets go") {
  // Nothing but gravity is left: g h more after each step whose impulses had not acted yet.
  const double gh = 9.81 * h;
  for (const auto& speeds : {speeds_of_let_go<stage::Islands>(), speeds_of_let_go<stage::Solve>()}) {
    REQUIRE(speeds[0] == Approx(gh));
    REQUIRE(speeds[1] == Approx(2 * gh));
  }
  const auto late = speeds_of_let_go<stage::Correct>();
  REQUIRE(std::abs(late[0]) < 1e-6 * gh);
  REQUIRE(late[1] == Approx(gh));
}

TEST_CASE("what rests for half a second sleeps: no pairs, no rows, and it stays to the bit") {
  Asleep scene;
  std::vector<Vec3> before;
  for (const auto body : scene.stack) before.push_back(scene.set().position(body));
  const StepReport r = scene.run(1000);
  REQUIRE(r.pairs == 0);
  REQUIRE(r.rows == 0);
  REQUIRE(r.contacts == 0);
  REQUIRE(scene.sleepers() == 3);
  for (std::size_t k = 0; k < 3; ++k) REQUIRE(scene.set().position(scene.stack[k]) == before[k]);
}

TEST_CASE("bodies asleep keep their place in every sum and box") {
  Asleep scene;
  REQUIRE(potential_energy(scene.set()) == Approx(g * (0.5 + 1.5 + 2.5)).epsilon(1e-6));
  REQUIRE(kinetic_energy(scene.set()) == 0);
  REQUIRE(bounds(scene.loop.world()).max().z() == Approx(3).epsilon(1e-6));
}

TEST_CASE("nothing sleeps at the top of a throw, in any gravity, nor in mid-swing") {
  for (const double gravity : {9.81, 1.6, 1e-3}) {
    auto loop = loop_with(Sleeping{});
    auto& set = rigid_bodies(loop);
    set.gravity = {0, 0, -gravity};
    set.add_fixed(HalfSpace{});
    const auto ball = set.add({.position = {0, 0, 50}, .velocity = {0, 0, 0.02 * gravity}, .mass = 1.0, .shape = Sphere{0.1}});
    const auto bob = set.add({.position = {7.5, 0, 5}, .mass = 1.0, .shape = Sphere{0.1}});
    loop.add(DistanceJoint::Item{anchor(set, bob), world_anchor({7, 0, 5}), 0.5});
    for (int n = 0; n < 120; ++n) {
      loop.step(h);
      REQUIRE(loop.dormant().bodies().empty());
    }
    REQUIRE(set.velocity(ball).z() < 0);
    REQUIRE(set.position(bob).z() < 5);
  }
}

TEST_CASE("a body that drifts without gravity goes on, one that stands may sleep") {
  auto loop = loop_with(Sleeping{});
  auto& set = rigid_bodies(loop);
  set.gravity.setZero();
  set.add({.position = {0, 0, 5}, .velocity = {0.01, 0, 0}, .mass = 1.0, .shape = Sphere{0.1}});
  set.add({.position = {0, 0, 9}, .mass = 1.0, .shape = Sphere{0.1}});
  for (int n = 0; n < 60; ++n) loop.step(h);
  REQUIRE(loop.dormant().bodies().size() == 1);
}

TEST_CASE("a force wakes the whole island, in time for the step it acts in") {
  Asleep scene;
  scene.set().apply_force(scene.stack[2], {0, 0, 100});
  scene.run(1);
  REQUIRE(scene.sleepers() == 0);
  REQUIRE(scene.set().velocity(scene.stack[2]).z() == Approx((100 - g) * h).epsilon(1e-6));
}

TEST_CASE("a velocity, another place and another gravity wake") {
  SECTION("velocity") {
    Asleep scene;
    scene.set().set_velocity(scene.stack[2], {1, 0, 0});
    scene.run(1);
    REQUIRE(scene.sleepers() == 0);
    REQUIRE(scene.set().velocity(scene.stack[2]).x() > 0.9);
  }
  SECTION("place") {
    Asleep scene;
    scene.set().place(scene.stack[0], {5, 0, 0.5});
    scene.run(60);
    REQUIRE(scene.set().position(scene.stack[2]).z() < 2);  // what stood on it has come down
  }
  SECTION("gravity") {
    Asleep scene;
    scene.set().gravity = {0, 0, 1};
    scene.run(60);
    REQUIRE(scene.set().position(scene.stack[2]).z() > 2.9);
  }
}

TEST_CASE("a body that falls on sleepers wakes them before it touches them") {
  Asleep scene;
  const auto ball = scene.set().add({.position = {0, 0, 4}, .mass = 1.0, .shape = Sphere{0.5}});
  scene.run(1);
  REQUIRE(scene.sleepers() == 3);
  bool have_slept = true;
  for (int n = 0; n < 60; ++n) {
    const StepReport r = scene.run(1);
    have_slept = have_slept && scene.sleepers() == 3;
    if (!have_slept) REQUIRE((r.contacts >= 12 || scene.sleepers() == 4));
    REQUIRE(scene.set().position(ball).z() > 3.49);
  }
  REQUIRE(!have_slept);
}

TEST_CASE("a body that passes by within the margin wakes nobody, and pushes nobody") {
  Asleep scene;
  scene.set().gravity = scene.set().gravity;  // no change is no cause
  const auto ball = scene.set().add({.position = {0.5 + 0.52, 0, 4}, .velocity = {0, 0, -1}, .mass = 1.0, .shape = Sphere{0.5}});
  scene.set().gravity.setZero();
  scene.run(60);                              // this change woke them, and without gravity they sleep again
  REQUIRE(scene.sleepers() == 3);
  scene.set().place(ball, {0.5 + 0.52, 0, 4});
  for (int n = 0; n < 100; ++n) {
    scene.run(1);
    REQUIRE(scene.sleepers() == 3);
  }
  REQUIRE(scene.set().velocity(ball) == Vec3(0, 0, -1));
}

TEST_CASE("a support that is moved, taken out or added wakes who lies on it or near") {
  SECTION("moved") {
    Asleep scene;
    scene.set().move_to(scene.floor, {0, 0, -0.4}, Quat::Identity());
    scene.run(1);  // carried along in this very step
    for (std::size_t k = 0; k < 3; ++k) REQUIRE(scene.set().position(scene.stack[k]).z() >= 0.6 + k - 1e-6);
  }
  SECTION("taken out") {
    Asleep scene;
    scene.loop.remove(scene.floor);
    scene.run(30);
    REQUIRE(scene.set().velocity(scene.stack[0]).z() == Approx(-30 * h * g).epsilon(1e-9));
  }
  SECTION("added") {
    Asleep scene;
    scene.set().add_fixed(Box{1, 1, 1}, {0.9, 0, 0.5});  // cuts into the lowest box
    scene.run(1);
    REQUIRE(scene.sleepers() == 0);
  }
}

TEST_CASE("one of their own taken out wakes the rest") {
  Asleep scene;
  scene.loop.remove(scene.stack[0]);
  scene.run(60);
  REQUIRE(scene.set().position(scene.stack[1]).z() == Approx(0.5).margin(1e-3));
}

TEST_CASE("a joint that is added or taken out wakes both its ends") {
  auto loop = loop_with(Sleeping{});
  auto& set = rigid_bodies(loop);
  set.add_fixed(HalfSpace{});
  const auto hung = set.add({.position = {0, 0, 3}, .mass = 2.0, .shape = Box{1, 1, 1}});
  const auto hook = loop.add(BallJoint::Item{anchor(set, hung, {0, 0, 0.5}), world_anchor({0, 0, 3.5})});
  const auto lying = set.add({.position = {0, 0, 0.5}, .mass = 1.0, .shape = Box{1, 1, 1}});
  StepReport r;
  for (int n = 0; n < 60; ++n) r = loop.step(h);
  REQUIRE(loop.dormant().bodies().size() == 2);
  REQUIRE(r.rows == 0);
  REQUIRE(loop.impulse(hook).norm() == Approx(2 * g * h).epsilon(1e-6));  // a sleeping joint still says what it holds
  const auto rope = loop.add(DistanceJoint::Item{anchor(set, hung), anchor(set, lying), 2});
  loop.step(h);
  REQUIRE(loop.dormant().bodies().empty());
  for (int n = 0; n < 120; ++n) loop.step(h);
  REQUIRE(loop.dormant().bodies().size() == 2);
  loop.remove(rope);
  loop.remove(hook);
  for (int n = 0; n < 30; ++n) loop.step(h);
  REQUIRE(set.position(hung).z() < 2.5);
}

namespace {

/// A body hangs asleep 2 m below a kinematic one, or lies on the floor and a slack string of 3 m leads there.
template <class Joint>
struct Held {
  AnimationLoop<World<RigidBodies>, Constraints<Contact<Coulomb>, Joint>, Sleeping> loop{
      World{RigidBodies{}}, Constraints{Contact{Coulomb{.friction = 0.5}}, Joint{}}, Sleeping{}};
  RigidBodies::Handle hook, body;

  template <class MakeItem>
  Held(bool is_hung, bool has_shape, const MakeItem& make_item) {
    auto& set = rigid_bodies(loop);
    if (!is_hung) set.add_fixed(HalfSpace{});
    RigidBody held{.position = {0, 0, 0.5}, .mass = 1.0, .inertia = 0.1 * Mat3::Identity()};
    if (has_shape) held.shape = Box{1, 1, 1};
    body = set.add(held);
    hook = set.add({.position = {0, 0, 2.5}, .motion = Motion::kinematic});
    loop.add(make_item(set, hook, body));
    for (int n = 0; n < 60; ++n) loop.step(h);
    REQUIRE(loop.dormant().bodies().size() == 1);
  }
  Held(const Held&) = delete;
  double height() { return rigid_bodies(loop).position(body).z(); }
  void lift(double speed, int steps) {
    for (int n = 1; n <= steps; ++n) {
      rigid_bodies(loop).move_to(hook, {0, 0, 2.5 + speed * h * n}, Quat::Identity());
      loop.step(h);
    }
  }
};

}  // namespace

TEST_CASE("who hangs on a joint wakes when its other end is moved, given a velocity, placed or taken out") {
  const auto rod = [](auto& set, auto hook, auto body) { return DistanceJoint::Item{anchor(set, hook), anchor(set, body), 2}; };
  for (const bool has_shape : {true, false}) {
    Held<DistanceJoint> moved(true, has_shape, rod), driven(true, has_shape, rod), placed(true, has_shape, rod), lost(true, has_shape, rod);
    moved.lift(0.5, 1);
    REQUIRE(moved.height() == Approx(0.5 + 0.5 * h).epsilon(1e-6));  // in this very step
    moved.lift(0.5, 60);
    REQUIRE(moved.height() == Approx(1).epsilon(1e-6));
    rigid_bodies(driven.loop).set_velocity(driven.hook, {0, 0, 0.5});
    for (int n = 0; n < 60; ++n) driven.loop.step(h);
    REQUIRE(driven.height() == Approx(1).epsilon(1e-6));
    rigid_bodies(placed.loop).place(placed.hook, {0, 0, 2.6}, Quat::Identity());
    for (int n = 0; n < 60; ++n) placed.loop.step(h);
    REQUIRE(placed.height() == Approx(0.6).epsilon(1e-3));
    lost.loop.remove(lost.hook);
    for (int n = 0; n < 30; ++n) lost.loop.step(h);
    REQUIRE(rigid_bodies(lost.loop).velocity(lost.body).z() == Approx(-30 * h * g).epsilon(1e-9));
  }
}

TEST_CASE("a string that grows taut draws a sleeper along") {
  Held<Limit<Length>> scene(false, true, [](auto& set, auto hook, auto body) {
    return Limit<Length>::Item{.a = anchor(set, hook), .b = anchor(set, body), .upper = 3};
  });
  scene.lift(0.5, 240);  // the hook goes 2 m up, and 1 m is slack
  REQUIRE(scene.height() == Approx(1.5).epsilon(1e-6));
}

TEST_CASE("sleepers on a joint wake after a checkpoint too") {
  const auto rod = [](auto& set, auto hook, auto body) { return DistanceJoint::Item{anchor(set, hook), anchor(set, body), 2}; };
  Held<DistanceJoint> first(true, true, rod), second(true, true, rod);
  restore(second.loop, checkpoint(first.loop));
  second.lift(0.5, 60);
  REQUIRE(second.height() == Approx(1).epsilon(1e-6));
}

TEST_CASE("where all sleep, a restored loop and new bodies far off disturb nobody") {
  Asleep scene;
  auto& set = scene.set();
  scene.run(1);
  Asleep restored;
  restore(restored.loop, checkpoint(scene.loop));
  for (int k = 0; k < 50; ++k) {
    const auto far = set.add({.position = {50.0 + 2 * k, 0, 0}, .shape = Box{1, 1, 1}, .motion = Motion::kinematic});
    set.set_velocity(far, {100, 0, 0});
  }
  const auto first = restored.set().add({.position = {50, 0, 0}, .shape = Box{1, 1, 1}, .motion = Motion::kinematic});
  restored.set().set_velocity(first, {100, 0, 0});
  scene.run(5);
  restored.run(5);
  REQUIRE(scene.sleepers() == 3);
  REQUIRE(restored.sleepers() == 3);
}

TEST_CASE("an island on a moving kinematic body stays awake, and all can be woken by hand") {
  Asleep scene;
  const Vec3 start = scene.set().position(scene.stack[0]);
  for (int n = 1; n <= 120; ++n) {  // slower than the threshold of sleep
    scene.set().move_to(scene.floor, {0.002 * h * n, 0, -0.5}, Quat::Identity());
    scene.run(1);
  }
  REQUIRE(scene.sleepers() == 0);
  REQUIRE(scene.set().position(scene.stack[0]).x() - start.x() == Approx(0.004).epsilon(0.02));
  scene.run(60);
  REQUIRE(scene.sleepers() == 3);
  scene.loop.wake(scene.stack[1]);
  REQUIRE(scene.sleepers() == 0);
  scene.run(60);
  scene.loop.wake_all();
  REQUIRE(scene.sleepers() == 0);
}

TEST_CASE("the awake move to the bit as if nobody slept") {
  auto with = loop_with(Sleeping{});
  auto without = loop_with(AllActive{});
  const auto build = [](auto& loop) {
    auto& set = rigid_bodies(loop);
    add_stack(set, 3, Box{1, 1, 1});
    set.add({.position = {8, 0, 3}, .velocity = {0.3, 0.1, 0}, .angular_velocity = {1, 2, 3}, .mass = 1.0, .shape = Box{1, 0.6, 0.4}});
    return set.add({.position = {5, 0, 3}, .mass = 1.0, .shape = Sphere{0.5}});
  };
  build(with);
  build(without);
  bool have_slept = false;
  for (int n = 0; n < 400; ++n) {
    with.step(h);
    without.step(h);
    have_slept = have_slept || !with.dormant().bodies().empty();
    auto &a = rigid_bodies(with), &b = rigid_bodies(without);
    for (const Index k : a.active()) REQUIRE(a.pose(k).position == b.pose(k).position);
  }
  REQUIRE(have_slept);
}

TEST_CASE("particles on springs do not sleep, and neither does what they hold") {
  AnimationLoop loop{World{RigidBodies{}, Particles{}}, Constraints{Contact{Coulomb{.friction = 0.5}}, BallJoint{}}, Sleeping{}};
  auto& set = loop.world().set<0>();
  auto& dust = loop.world().set<1>();
  set.add_fixed(HalfSpace{});
  set.add({.position = {0, 0, 0.5}, .mass = 1.0, .shape = Box{1, 1, 1}});
  const auto held = set.add({.position = {5, 0, 0.5}, .mass = 1.0, .shape = Box{1, 1, 1}});
  const auto p = dust.add({.position = {5, 0, 1}, .mass = 0.1});
  dust.add_spring(p, Vec3(5, 0, 1.5), 10, 1);
  loop.add(BallJoint::Item{anchor(set, held, {0, 0, 0.5}), anchor(dust, p)});
  for (int n = 0; n < 240; ++n) loop.step(h);
  REQUIRE(loop.dormant().bodies().size() == 1);
}

TEST_CASE("limits of sleep that make no sense are refused") {
  REQUIRE_THROWS_WITH(loop_with(Sleeping{.speed = -1}), Catch::Contains("Sleeping: speed -1 m/s"));
  REQUIRE_THROWS_WITH(loop_with(Sleeping{.after = 0}), Catch::Contains("Sleeping: after 0 s"));
}

}  // namespace sleeping_tests
