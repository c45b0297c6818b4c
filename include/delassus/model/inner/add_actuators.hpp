/// The actuators of a model as forces, springs and drives of a loop.
#pragma once

#include <delassus/constraints/joints/drive.hpp>
#include <delassus/constraints/joints/spring_damper.hpp>
#include <delassus/core/cmath.hpp>
#include <delassus/model/inner/add_tendons.hpp>
#include <delassus/model/inner/lumps.hpp>

#include <algorithm>
#include <limits>
#include <string>

namespace delassus::inner {

/// k and c of an actuator to its length before the gear.
inline double stiffness_of(const model::Actuator& a) { return -a.bias[1] * a.gear[0] * a.gear[0]; }
inline double damping_of(const model::Actuator& a) { return -a.bias[2] * a.gear[0] * a.gear[0]; }

/// What an actuator moves; says why it moves nothing, if so.
template <class Builder>
std::string find_parts(Builder& builder, const model::Actuator& actuator, TendonParts& sum) {
  const Model& model = builder.model();
  if (actuator.transmission == model::Transmission::joint) {
    const auto kind = model.joints[std::size_t(actuator.target)].kind;
    if (kind == model::JointKind::ball || kind == model::JointKind::free)
      return "its joint is a ball or free";
    sum = joint_parts(builder, actuator.target, 1);
    if (sum.parts.empty()) return "nothing moves its joint";
  } else {
    sum = tendon_parts(builder, model.tendons[std::size_t(actuator.target)]);
    if (sum.parts.empty()) return "nothing moves its tendon";
    if (int(sum.parts.size()) > most_tendon_parts)
      return "its tendon has more than " + std::to_string(most_tendon_parts) + " parts";
  }
  return {};
}

/// The cap of its force at the length before the gear; its mean is pushed beside the law.
inline double cap_of(const model::Actuator& a) {
  return a.force_is_limited ? std::abs(a.gear[0]) * (a.force_upper - a.force_lower) / 2
                            : std::numeric_limits<double>::infinity();
}

template <class Builder>
void add_law(Builder& builder, model::Actuation& act, const TendonParts& sum) {
  const double stiffness = stiffness_of(act.actuator), damping = damping_of(act.actuator);
  const bool is_spring = act.law == model::Actuation::Law::spring;
  act.is_tendon = sum.parts.size() > 1 || sum.parts[0].coefficient * sum.parts[0].coefficient != 1;
  if (act.is_tendon) {
    const auto set = [&](auto& item) { item.stiffness = stiffness, item.damping = damping; };
    if (is_spring)
      act.size = emit_tendon<Tendon>(builder, "Tendon", sum, act.constraint, set);
    else
      act.size = emit_tendon<TendonMotor>(builder, "TendonMotor", sum, act.constraint, [&](auto& item) {
        set(item), item.max_force = cap_of(act.actuator);
      });
    return;
  }
  const TendonPart& part = sum.parts[0];
  with_axis(part.kind, [&]<class C>() {
    const std::string name = name_of(part.kind);
    if (is_spring)
      act.constraint = builder.template emit<SpringDamper<C>>(("SpringDamper<" + name + ">{}").c_str(), [&] {
        return typename SpringDamper<C>::Item{
            .a = part.a, .b = part.b, .stiffness = stiffness, .damping = damping, .position = part.position};
      });
    else
      act.constraint = builder.template emit<Drive<C>>(("Drive<" + name + ">{}").c_str(), [&] {
        return typename Drive<C>::Item{.a = part.a,
                                       .b = part.b,
                                       .stiffness = stiffness,
                                       .damping = damping,
                                       .max_force = cap_of(act.actuator),
                                       .position = part.position};
      });
  });
}

/// Springs and dampers are implicit where they take energy out; all else is a force.
inline model::Actuation::Law law_of(const model::Actuator& a) {
  using Law = model::Actuation::Law;
  const bool yields = a.bias[1] <= 0 && a.bias[2] <= 0 && (stiffness_of(a) > 0 || damping_of(a) > 0);
  return !yields ? Law::force : a.force_is_limited ? Law::motor : Law::spring;
}

template <class Builder>
void add_actuators(Builder& builder) {
  const Model& model = builder.model();
  Machine& machine = builder.machine();
  machine.controls.assign(model.actuators.size(), 0);
  machine.activations.assign(model.actuators.size(), 0);
  machine.actuators.clear();
  for (const model::Actuator& actuator : model.actuators) {
    model::Actuation& act = machine.actuators.emplace_back();
    act.actuator = actuator;
    builder.speak_of("actuator", actuator.name);
    if (builder.leave_out().actuators) continue;
    if (actuator.transmission == model::Transmission::site) {
      const model::Site& site = model.sites[std::size_t(actuator.target)];
      const bool is_held = site.body < 0 || machine.parts[std::size_t(site.body)].is_world;
      if (is_held) {
        builder.leave("actuator '" + actuator.name + "' does not act: the world holds its site");
        continue;
      }
      const model::Part& part = machine.parts[std::size_t(site.body)];
      act.site = {.body = part.body, .is_world = false, .pose = Lumps::in(part.pose, site.pose)};
      act.law = model::Actuation::Law::force;
      continue;
    }
    TendonParts sum;
    if (const std::string why = find_parts(builder, actuator, sum); !why.empty()) {
      builder.leave("actuator '" + actuator.name + "' does not act: " + why);
      continue;
    }
    act.law = law_of(actuator);
    act.parts = sum.parts;
    act.offset = sum.offset;
    if (act.law != model::Actuation::Law::force) add_law(builder, act, sum);
  }
}

}  // namespace delassus::inner
