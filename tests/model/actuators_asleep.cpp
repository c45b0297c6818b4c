// A machine at rest falls asleep, and a control that changes wakes it.
#include "model/one_link.hpp"

#include <delassus/activity/hand_picked.hpp>
#include <delassus/activity/sleeping.hpp>
#include <delassus/constraints/joints/tendon.hpp>

#include "catch.hpp"

#include <cmath>

namespace actuators_asleep_tests {

using namespace delassus;

namespace {

template <class Activity>
auto loop_with(Activity activity) {
  AnimationLoop loop{World{RigidBodies{}},
                     Constraints{Hinge{}, SpringDamper<Turn>{}, Drive<Turn>{}, Tendon<1>{}, TendonMotor<1>{}},
                     GaussSeidel{.tolerance = 1e-9}, activity};
  weightless(loop);
  return loop;
}
/// A servo by the hinge or by a tendon of twice its angle, with a cap or without.
Model servo(bool by_tendon, bool has_cap) {
  Model model = one_link(20, {0, -20, -4});
  model::Actuator& motor = model.actuators[0];
  motor.force_is_limited = has_cap, motor.force_lower = -5, motor.force_upper = 5;
  if (by_tendon) {
    model::Tendon tendon;
    tendon.name = "cord", tendon.joints = {{0, 2}};
    model.tendons = {tendon};
    motor.transmission = model::Transmission::tendon;
  }
  return model;
}

}  // namespace

TEST_CASE("a machine asleep follows a control that changes") {
  for (const bool by_tendon : {false, true})
    for (const bool has_cap : {false, true}) {
      auto loop = loop_with(Sleeping{});
      Machine machine = add(loop, servo(by_tendon, has_cap));
      const auto go = [&](int steps) {
        for (int n = 0; n < steps; ++n) actuate(loop, machine, 1e-2), loop.step(1e-2);
      };
      go(200);
      CAPTURE(by_tendon, has_cap);
      CHECK(loop.dormant().bodies().size() == 1);  // the same control again wakes nobody
      set_control(machine, "motor", 0.5);
      go(1);
      CHECK(loop.dormant().bodies().empty());
      go(1000);
      CHECK(position_of(loop.world(), machine, 0) == Approx(by_tendon ? 0.25 : 0.5).margin(2e-3));
      CHECK(loop.dormant().bodies().size() == 1);
    }
}

TEST_CASE("a machine asleep follows its filter") {
  auto loop = loop_with(Sleeping{});
  Model model = servo(false, false);
  model.actuators[0].time_constant = 2;
  Machine machine = add(loop, model);
  for (int n = 0; n < 200; ++n) actuate(loop, machine, 1e-2), loop.step(1e-2);
  REQUIRE(loop.dormant().bodies().size() == 1);
  set_control(machine, "motor", 0.5);
  for (int n = 0; n < 3000; ++n) actuate(loop, machine, 1e-2), loop.step(1e-2);
  CHECK(position_of(loop.world(), machine, 0) == Approx(0.5).margin(2e-3));
}

TEST_CASE("a control wakes nobody whom the host switched off") {
  auto loop = loop_with(HandPicked{});
  Machine machine = add(loop, servo(false, false));
  loop.switch_off(machine.parts[0].body);
  set_control(machine, "motor", 0.5);
  for (int n = 0; n < 100; ++n) actuate(loop, machine, 1e-2), loop.step(1e-2);
  CHECK(loop.dormant().bodies().size() == 1);
  CHECK(position_of(loop.world(), machine, 0) == 0);
}

}  // namespace actuators_asleep_tests
