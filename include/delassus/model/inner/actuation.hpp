/// One actuator of a machine: what its filter makes of a control, its force, and how it reaches the bodies.
#pragma once

#include <delassus/constraints/joints/drive.hpp>
#include <delassus/constraints/joints/spring_damper.hpp>
#include <delassus/constraints/pool.hpp>
#include <delassus/core/cmath.hpp>
#include <delassus/model/inner/add_actuators.hpp>
#include <delassus/model/machine.hpp>

#include <algorithm>
#include <type_traits>

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

/// Pushes with `force` before the gear, halfway through a step of h.
template <class Loop>
void push_by(Loop& loop, const model::Actuation& act, double force, double h) {
  const model::Actuator& a = act.actuator;
  if (force == 0) return;
  if (a.transmission == model::Transmission::site) {
    RigidBodies& set = bodies<RigidBodies>(loop.world());
    const Pose site = site_of(loop.world(), act, h / 2);
    const Vec3 pull = force * gear_of_site(a, site.rotation, 0);
    const Vec3 arm = site.position - set.position(act.site.body) - h / 2 * set.velocity(act.site.body);
    set.apply_force(act.site.body, pull);
    set.apply_torque(act.site.body, force * gear_of_site(a, site.rotation, 3) + cross(arm, pull));
    return;
  }
  for (const TendonPart& part : act.parts)
    push_between(loop.world(), part.kind, part.a, part.b, part.coefficient * a.gear[0] * force, h / 2);
}

/// f(item) of the actuator's constraint of this law; nothing where the loop does not name the law.
template <class Law, class Loop, class F>
void with_item(Loop& loop, const model::Actuation& act, F&& f) {
  if constexpr (!std::is_void_v<typename Loop::Laws::template law_of<typename Law::Item>::type>) {
    const model::ConstraintNumber& number = act.constraint;
    f(loop.item(ConstraintHandle<Law>{number.index, number.generation, number.owner}));
  }
}
template <template <int> class Law, int n = 1, class Loop, class F>
void with_tendon_item(Loop& loop, const model::Actuation& act, F&& f) {
  if constexpr (n <= most_tendon_parts) {
    if (act.size == n)
      with_item<Law<n>>(loop, act, f);
    else
      with_tendon_item<Law, n + 1>(loop, act, f);
  }
}

/// f(item) of a spring's rest, or of a motor's target and speed.
template <class Loop, class Spring, class Motor>
void with_law(Loop& loop, const model::Actuation& act, const Spring& spring, const Motor& motor) {
  const bool is_spring = act.law == model::Actuation::Law::spring;
  if (act.is_tendon && is_spring) return with_tendon_item<Tendon>(loop, act, spring);
  if (act.is_tendon) return with_tendon_item<TendonMotor>(loop, act, motor);
  with_axis(act.parts[0].kind, [&]<class C>() {
    if (is_spring)
      with_item<SpringDamper<C>>(loop, act, spring);
    else
      with_item<Drive<C>>(loop, act, motor);
  });
}

/// The force of a control for a step of h, where a law gives what depends on length and rate:
///
///   gear (gain u + b₀) − k x − c ẋ,   x = offset + Σ coefficient · coordinate, before the gear.
template <class Loop>
void apply(Loop& loop, const model::Actuation& act, double control, double h) {
  using Law = model::Actuation::Law;
  const model::Actuator& a = act.actuator;
  if (act.law == Law::force) return push_by(loop, act, force_of(loop.world(), act, control, h / 2), h);
  // A cap about its mean, which is a force of its own.
  const double mean = act.law == Law::motor ? (a.force_lower + a.force_upper) / 2 : 0;
  const double drive = a.gain * control + a.bias[0] - mean, stiffness = stiffness_of(a),
               damping = damping_of(a);
  const double side = act.is_tendon ? 1 : act.parts[0].coefficient;  // ±1: to the coordinate of a joint
  const double rest = side * (stiffness > 0 ? a.gear[0] * drive / stiffness - act.offset : 0);
  const double speed = side * (stiffness > 0 ? 0 : a.gear[0] * drive / damping);
  with_law(
      loop, act, [&](auto& item) { item.rest = rest; },
      [&](auto& item) { item.target = rest, item.speed = speed; });
  push_by(loop, act, act.law == Law::spring && !(stiffness > 0) ? drive : mean, h);
}

}  // namespace delassus::inner
