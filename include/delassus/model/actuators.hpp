/// Controls of a machine: what its actuators are told, and the forces that come of it.
#pragma once

#include <delassus/constraints/joints/drive.hpp>
#include <delassus/constraints/joints/spring_damper.hpp>
#include <delassus/model/inner/actuation.hpp>
#include <delassus/model/machine.hpp>

#include <string>
#include <string_view>
#include <vector>

namespace delassus {

/// The number of an actuator by its name, as in `machine.controls`. Refuses a name that there is not, with a
/// list of those that are.
inline Index actuator_of(const Machine& machine, std::string_view name) {
  std::string names;
  for (std::size_t k = 0; k < machine.actuators.size(); ++k) {
    if (machine.actuators[k].actuator.name == name) return Index(k);
    names += (k > 0 ? ", '" : " '") + machine.actuators[k].actuator.name + "'";
  }
  inner::refuse("actuator_of: this machine has no actuator '" + std::string(name) + "'; it has" +
                (names.empty() ? " none" : names));
}

/// `machine.controls` of one actuator.
inline void set_control(Machine& machine, std::string_view name, double value) {
  machine.controls[std::size_t(actuator_of(machine, name))] = value;
}

/// Controls and activations of a keyframe of the model; what it does not say is 0.
inline void set_controls(Machine& machine, const model::Keyframe& key) {
  std::size_t filter = 0;
  for (std::size_t k = 0; k < machine.actuators.size(); ++k) {
    machine.controls[k] = k < key.control.size() ? key.control[k] : 0;
    machine.activations[k] = 0;
    if (machine.actuators[k].actuator.time_constant > 0)
      machine.activations[k] = filter < key.activation.size() ? key.activation[filter++] : 0;
  }
}

/// The force of an actuator now, before its gear and as its limits allow, with the control or activation that
/// it has: N or N·m. 0 of one that does not act.
template <class World>
double actuator_force(const World& world, const Machine& machine, Index k) {
  DELASSUS_EXPECT(k >= 0 && std::size_t(k) < machine.actuators.size(),
                  "actuator_force: this machine has no actuator " + std::to_string(k));
  const model::Actuation& act = machine.actuators[std::size_t(k)];
  if (act.law == model::Actuation::Law::none) return 0;
  const model::Actuator& a = act.actuator;
  const double control = a.time_constant > 0 ? machine.activations[std::size_t(k)]
                                             : inner::clamped_control(a, machine.controls[std::size_t(k)]);
  return inner::force_of(world, act, control);
}

/// Drives the machine in the next step of h s, by `machine.controls`: call it before each step. Filters
/// advance by h, exactly for a control that stays. What is stiff or damps is implicit, by the law that `add`
/// chose. A plain force, one on a site and one whose gains feed energy in act as they are halfway through the
/// step if the velocities stay. Controls that are not finite are refused. Angles of servos count whole turns
/// from where `add` or `set_joint_state` put them.
template <class Loop>
void actuate(Loop& loop, Machine& machine, double h) {
  inner::expect_positive("actuate: h", h, "s");
  for (std::size_t k = 0; k < machine.actuators.size(); ++k) {
    const model::Actuation& act = machine.actuators[k];
    DELASSUS_EXPECT(std::isfinite(machine.controls[k]),
                    "actuate: the control of actuator '" + act.actuator.name + "' is not finite");
    const double control = inner::filtered(act.actuator, machine.controls[k], h, machine.activations[k]);
    if (act.law != model::Actuation::Law::none) inner::apply(loop, act, control, h);
  }
}

}  // namespace delassus
