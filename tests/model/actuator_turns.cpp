// Servos over whole turns: what counts them, who tells them anew, and what a checkpoint needs beside it.
#include "model/one_link.hpp"

#include <delassus/core/archive.hpp>
#include <delassus/io/checkpoint.hpp>
#include <delassus/model/joint_state.hpp>
#include <delassus/solvers/direct_gauss_seidel.hpp>

#include "catch.hpp"

#include <cmath>
#include <numbers>
#include <vector>

namespace actuator_turns_tests {

using namespace delassus;

namespace {

auto loop_of(auto... laws) {
  AnimationLoop loop{World{RigidBodies{}}, Constraints{Hinge{}, laws...},
                     DirectGaussSeidel{.tolerance = 1e-10}};
  weightless(loop);
  return loop;
}
constexpr double turn = 2 * std::numbers::pi;

}  // namespace

// I q'' = −k q + ε q̇ swings out to v₀/w = 6 rad, w = √(k/I) = 10/s. ε > 0 feeds energy in, so that the servo
// is a force; a first-order rule is off by some h w of the amplitude.
TEST_CASE("a servo that is a force counts whole turns, and so does what is read of it") {
  Machine machine;
  auto loop = loop_of();
  machine = add(loop, one_link(20, {0, -20, 1e-9}));
  auto& set = bodies<RigidBodies>(loop.world());
  set.set_velocity(machine.parts[0].body, zero<Vec3>(), {0, 60, 0});
  const double h = 1e-4;
  double angle = 0, most = 0;
  for (int n = 1; n <= 6000; ++n) {
    actuate(loop, machine, h), loop.step(h);
    angle += h * set.angular_velocity(machine.parts[0].body)[1];
    most = std::max(most, std::abs(angle));
    if (n % 500 != 0) continue;
    CAPTURE(n);
    CHECK(angle == Approx(6 * std::sin(10 * n * h)).margin(6 * 20 * h));
    CHECK(actuator_force(loop.world(), machine, 0) == Approx(-20 * angle).margin(1e-6));
  }
  CHECK(most > 5.9);
}

TEST_CASE("the force of an implicit servo is read over whole turns") {
  auto loop = loop_of(SpringDamper<Turn>{});
  Machine machine = add(loop, one_link(20, {0, -20, -4}));
  set_control(machine, "motor", 10);
  for (int n = 0; n < 3000; ++n) actuate(loop, machine, 1e-2), loop.step(1e-2);
  CHECK(rate_of(loop.world(), machine, 0) == Approx(0).margin(1e-9));
  CHECK(actuator_force(loop.world(), machine, 0) == Approx(0).margin(1e-6));
}

// Three turns on, the servo of either kind is where it is told to be: it does not move.
TEST_CASE("set_joint_state tells the turns to servos and limits") {
  for (const double feeds : {0., 1e-9}) {
    Model model = one_link(20, {0, -20, feeds});
    model.joints[0].is_limited = true, model.joints[0].lower = 3 * turn,
    model.joints[0].upper = 3 * turn + 0.2;
    auto loop = loop_of(SpringDamper<Turn>{}, Limit<Turn>{});
    Machine machine = add(loop, model);
    JointSpace space(model);
    const std::vector<double> q{3 * turn + 0.1}, v{0};
    set_joint_state(loop, machine, space, q, v);
    set_control(machine, "motor", q[0]);
    for (int n = 0; n < 50; ++n) actuate(loop, machine, 1e-2), loop.step(1e-2);
    CAPTURE(feeds);
    CHECK(std::abs(rate_of(loop.world(), machine, 0)) < 1e-9);
    set_control(machine, "motor", q[0] + 1);  // to its stop: 0.1 rad on
    for (int n = 0; n < 300; ++n) actuate(loop, machine, 1e-2), loop.step(1e-2);
    CHECK(position_of(loop.world(), machine, 0) == Approx(0.2).margin(1e-6));
  }
}

TEST_CASE("a checkpoint and the memory of the machine go on as the loop did") {
  const Model model = one_link(20, {0, -20, 1e-9}, 0.5);
  auto loop = loop_of();
  Machine machine = add(loop, model);
  machine.controls[0] = 9;
  const auto go = [](auto& which, Machine& own) {
    for (int n = 0; n < 40; ++n) actuate(which, own, 1e-2), which.step(1e-2);
  };
  go(loop, machine);
  const std::vector<char> bytes = checkpoint(loop);
  ArchiveWriter beside;
  machine.memory(beside);

  auto other = loop_of();
  Machine own = add(other, model);
  restore(other, bytes);
  ArchiveReader reader(beside.data);
  own.memory(reader);
  CHECK(reader.is_at_end());
  go(loop, machine), go(other, own);
  CHECK(position_of(other.world(), own, 0) == position_of(loop.world(), machine, 0));
  CHECK(own.activations == machine.activations);
  CHECK(state_hash(other) == state_hash(loop));

  Machine bigger = machine;
  bigger.actuators.push_back(machine.actuators[0]);
  bigger.controls = {3, 4}, bigger.activations = {5, 6};
  ArchiveReader again(beside.data);
  CHECK_THROWS(bigger.memory(again));
  CHECK(bigger.controls == std::vector<double>{3, 4});
  CHECK(bigger.activations == std::vector<double>{5, 6});
}

}  // namespace actuator_turns_tests
