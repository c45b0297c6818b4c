/// One actuator of a machine: what its filter makes of a control, and its force.
#pragma once

#include <delassus/core/cmath.hpp>
#include <delassus/model/machine.hpp>

#include <algorithm>
#include <string>

namespace delassus::inner {

inline double clamped_control(const model::Actuator& a, double control) {
  return a.control_is_limited ? std::clamp(control, a.control_lower, a.control_upper) : control;
}
inline double clamped_force(const model::Actuator& a, double force) {
  return a.force_is_limited ? std::clamp(force, a.force_lower, a.force_upper) : force;
}

/// The mean over h of ȧ = (u − a)/τ; `activation` goes to the end of it. Without a filter the control itself.
inline double filtered(const model::Actuator& a, double control, double h, double& activation) {
  const double u = clamped_control(a, control);
  if (!(a.time_constant > 0)) return u;
  const double gone = -std::expm1(-h / a.time_constant), start = activation;  // 1 − e^(−h/τ)
  activation = start + (u - start) * gone;
  return u + (start - u) * gone * a.time_constant / h;
}

/// The frame of an actuator's site in the world, as it will be in `ahead` s: its point and its axes.
template <class World>
Pose site_of(const World& world, const model::Actuation& act, double ahead = 0) {
  const RigidBodies& set = bodies<RigidBodies>(world);
  const auto body = act.site.body;
  const Quat turn = exponential<double>(Vec3(ahead * set.angular_velocity(body)));
  const Pose own{set.position(body) + ahead * set.velocity(body),
                 rotation_matrix(turn * set.orientation(body))};
  return {own.to_world(act.site.pose.position), own.rotation * act.site.pose.rotation};
}
/// The force (first) and the moment that gear says, in the world.
inline Vec3 gear_of_site(const model::Actuator& a, const Mat3& axes, int first) {
  return axes *
         Vec3(a.gear[std::size_t(first)], a.gear[std::size_t(first) + 1], a.gear[std::size_t(first) + 2]);
}

/// Refuses what an actuator is told or moves, unless the rule holds.
inline void expect_of(const model::Actuation& act, bool holds, const char* rule) {
  if (!holds) refuse("actuate: actuator '" + act.actuator.name + "': " + rule);
}
/// Refuses an actuator whose bodies are not in this world.
template <class World>
void expect_there(const World& world, const model::Actuation& act, const char* what) {
  const RigidBodies& set = bodies<RigidBodies>(world);
  std::string why;
  if (act.law != model::Actuation::Law::none && act.actuator.transmission == model::Transmission::site)
    why = what_is_wrong(set, act.site.body);
  for (const TendonPart& part : act.parts)
    if (why.empty()) why = what_is_wrong(set, part.a, part.b);
  if (!why.empty()) refuse(std::string(what) + ": actuator '" + act.actuator.name + "': " + why);
}

/// Counts turns on, from the last step to this one.
template <class World>
void follow(const World& world, model::Actuation& act) {
  if (act.actuator.bias[1] == 0) return;
  for (TendonPart& part : act.parts)
    part.position = axis_value(part.kind, {part.a, part.b, world}, part.position);
}

struct LengthAndRate {
  double length = 0, rate = 0;
};

/// Behind the gear. A site has no length.
template <class World>
LengthAndRate measure(const World& world, const model::Actuation& act) {
  const model::Actuator& a = act.actuator;
  if (a.transmission == model::Transmission::site) {
    const RigidBodies& set = bodies<RigidBodies>(world);
    const Pose site = site_of(world, act);
    const Vec3 spin = set.angular_velocity(act.site.body),
               v = set.velocity(act.site.body) +
                   cross(spin, Vec3(site.position - set.position(act.site.body)));
    return {0, dot(gear_of_site(a, site.rotation, 0), v) + dot(gear_of_site(a, site.rotation, 3), spin)};
  }
  LengthAndRate sum{act.offset, 0};
  for (const TendonPart& part : act.parts) {
    sum.length += part.coefficient * axis_value(part.kind, {part.a, part.b, world}, part.position);
    sum.rate += part.coefficient * rate_between(world, part.kind, part.a, part.b);
  }
  return {a.gear[0] * sum.length, a.gear[0] * sum.rate};
}

/// Before the gear, with the length that its rate makes in `ahead` s.
template <class World>
double force_of(const World& world, const model::Actuation& act, double control, double ahead = 0) {
  const model::Actuator& a = act.actuator;
  double force = a.gain * control + a.bias[0];
  if (a.bias[1] != 0 || a.bias[2] != 0) {
    const auto [length, rate] = measure(world, act);
    force += a.bias[1] * (length + ahead * rate) + a.bias[2] * rate;
  }
  return clamped_force(a, force);
}

}  // namespace delassus::inner
