#include "allocations/count_allocations.hpp"

#include "catch.hpp"
#include "model/one_link.hpp"

#include <delassus/constraints/joints/tendon.hpp>

using namespace delassus;

TEST_CASE("no step of a driven machine allocates") {
  Model model = one_link(20, {0, -20, -1}, 0.1);  // a servo
  model.bodies[0].gravity_compensation = 1;
  model::Tendon cord;
  cord.name = "cord", cord.joints = {{0, 2}};
  model.tendons = {cord};
  for (const model::Transmission by :
       {model::Transmission::joint, model::Transmission::tendon, model::Transmission::site}) {
    model::Actuator force = model.actuators[0];
    force.name = "force " + std::to_string(int(by)), force.transmission = by, force.bias = {0, 0, 0.1};
    model.actuators.push_back(force);
  }
  model.actuators.push_back(model.actuators[2]);  // by the tendon, and with a cap
  model.actuators.back().name = "capped", model.actuators.back().bias = {0, -1, -1};
  model.actuators.back().force_is_limited = true, model.actuators.back().force_upper = 1;
  AnimationLoop loop{World{RigidBodies{}}, Constraints{Hinge{}, SpringDamper<Turn>{}, TendonMotor<1>{}},
                     Sleeping{}};
  Machine machine = add(loop, model);
  const auto go = [&](int steps) {
    for (int n = 0; n < steps; ++n) {
      for (double& control : machine.controls) control = 0.1 * (n % 7);
      actuate(loop, machine, 1e-2), loop.step(1e-2);
    }
  };
  go(20);
  const long before = allocations;
  go(50);
  CHECK(allocations == before);
  CHECK(rate_of(loop.world(), machine, 0) != 0);
}
