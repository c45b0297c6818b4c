/// Controls of a machine: what its actuators are told, and the forces that come of it.
#pragma once

#include <delassus/model/inner/lift.hpp>
#include <delassus/model/inner/orders.hpp>
#include <delassus/model/machine.hpp>

#include <string>
#include <string_view>
#include <vector>

namespace delassus {

/// The number of an actuator by its name, as in `machine.controls`. Refuses a name that there is not, with a
/// list of those that are.
inline Index actuator_of(const Machine& machine, std::string_view name) {
  for (std::size_t k = 0; k < machine.actuators.size(); ++k)
    if (machine.actuators[k].actuator.name == name) return Index(k);
  std::string names;
  for (const model::Actuation& act : machine.actuators)
    names += (names.empty() ? " '" : ", '") + act.actuator.name + "'";
  inner::refuse("actuator_of: this machine has no actuator '" + std::string(name) + "'; it has" +
                (names.empty() ? " none" : names));
}

/// `machine.controls` of one actuator.
inline void set_control(Machine& machine, std::string_view name, double value) {
  const Index k = actuator_of(machine, name);
  machine.expect_controls("set_control");
  machine.controls[std::size_t(k)] = value;
}

/// Controls and activations of a keyframe of the model; what it does not say is 0. Refuses one of another
/// model, with more or fewer numbers than the machine has actuators and filters, and numbers that are not
/// finite.
inline void set_controls(Machine& machine, const model::Keyframe& key) {
  machine.expect_controls("set_controls");
  std::size_t filters = 0;
  for (const model::Actuation& act : machine.actuators) filters += act.actuator.time_constant > 0;
  const auto check = [&](const std::vector<double>& list, std::size_t count, const char* what) {
    DELASSUS_EXPECT(list.empty() || list.size() == count, "set_controls: keyframe '" + key.name + "' has " +
                                                              std::to_string(list.size()) + " " + what +
                                                              ", and the machine " + std::to_string(count) +
                                                              "; take a keyframe of its model");
    for (const double x : list)
      DELASSUS_EXPECT(std::isfinite(x), "set_controls: one of the " + std::string(what) + " of keyframe '" +
                                            key.name + "' is not finite");
  };
  check(key.control, machine.actuators.size(), "controls");
  check(key.activation, filters, "activations");
  std::size_t filter = 0;
  for (std::size_t k = 0; k < machine.actuators.size(); ++k) {
    const bool has_filter = machine.actuators[k].actuator.time_constant > 0;
    machine.controls[k] = key.control.empty() ? 0 : key.control[k];
    machine.activations[k] = has_filter && !key.activation.empty() ? key.activation[filter++] : 0;
  }
}

/// The force of an actuator now, before its gear and as its limits allow, with the control or activation that
/// it has: N or N·m. 0 of one that does not act.
template <class World>
double actuator_force(const World& world, const Machine& machine, Index k) {
  DELASSUS_EXPECT(k >= 0 && std::size_t(k) < machine.actuators.size(),
                  "actuator_force: this machine has no actuator " + std::to_string(k));
  machine.expect_controls("actuator_force");
  const model::Actuation& act = machine.actuators[std::size_t(k)];
  if (act.law == model::Actuation::Law::none) return 0;
  inner::expect_there(world, act, "actuator_force");
  const model::Actuator& a = act.actuator;
  const double control = a.time_constant > 0 ? machine.activations[std::size_t(k)]
                                             : inner::clamped_control(a, machine.controls[std::size_t(k)]);
  return inner::force_of(world, act, control);
}

/// Drives the machine in the next step of h s, by `machine.controls`: call it before each step. Filters
/// advance by h, exactly for a control that stays. What is stiff or damps is implicit, by the law that `add`
/// chose. A plain force, one on a site and one whose gains feed energy in act as they are halfway through the
/// step if the velocities stay. Angles of servos count whole turns from where `add` or `set_joint_state` put
/// them, while none makes half a turn from one call to the next. A control that changes wakes the bodies.
/// Weight that the model takes off is taken off here too; such bodies do not fall asleep.
///
/// Refuses, before any actuator acts: controls and activations that are not finite, or make a force that is
/// not; lists of them that have another size; bodies that were removed; and another loop.
template <class Loop>
void actuate(Loop& loop, Machine& machine, double h) {
  inner::expect_positive("actuate: h", h, "s");
  machine.expect_controls("actuate");
  auto& set = bodies<RigidBodies>(loop.world());
  inner::expect_lifts(set, machine, "actuate");
  for (std::size_t k = 0; k < machine.actuators.size(); ++k)
    inner::find_order(loop, machine.actuators[k], machine.controls[k], machine.activations[k], h);
  inner::push_up(set, machine, h);
  for (std::size_t k = 0; k < machine.actuators.size(); ++k) {
    machine.activations[k] = machine.actuators[k].order.activation;
    inner::carry_out(loop, machine.actuators[k], h);
  }
}

}  // namespace delassus
