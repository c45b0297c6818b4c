/// Orders of actuators: what each shall do in a step is found first, then all of it is done.
#pragma once

#include <delassus/constraints/joints/drive.hpp>
#include <delassus/constraints/joints/spring_damper.hpp>
#include <delassus/constraints/pool.hpp>
#include <delassus/core/cmath.hpp>
#include <delassus/model/inner/actuation.hpp>
#include <delassus/model/inner/add_actuators.hpp>

#include <type_traits>

namespace delassus::inner {

/// f(item) of the actuator's constraint of this law.
template <class Law, class Loop, class F>
void with_item(Loop& loop, const model::Actuation& act, F&& f) {
  if constexpr (!std::is_void_v<typename Loop::Laws::template law_of<typename Law::Item>::type>) {
    const model::ConstraintNumber& number = act.constraint;
    const ConstraintHandle<Law> handle{number.index, number.generation, number.owner};
    expect_of(act, loop.contains(handle), "its constraint was removed, or is in another loop");
    f(loop.item(handle));
  } else {
    expect_of(act, false, "its law is none of this loop, which is another one");
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

/// spring(item) or motor(item), as its law is.
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

inline bool has_law(const model::Actuation& act) {
  return act.law == model::Actuation::Law::spring || act.law == model::Actuation::Law::motor;
}

/// The largest number of what a force of 1 before the gear becomes at the bodies.
inline double largest_gear(const model::Actuation& act) {
  double most = 0;
  if (act.actuator.transmission == model::Transmission::site)
    for (const double g : act.actuator.gear) most = std::max(most, std::abs(g));
  for (const TendonPart& part : act.parts)
    most = std::max(most, std::abs(part.coefficient * act.actuator.gear[0]));
  return most;
}

/// Its order for a step of h. Where a law gives what depends on length and rate, the force of a control is
///
///   gear (gain u + b₀) − k x − c ẋ,   x = offset + Σ coefficient · coordinate, before the gear.
///
/// Refuses what it cannot be; nothing acts yet.
template <class Loop>
void find_order(Loop& loop, model::Actuation& act, double control, double activation, double h) {
  using Law = model::Actuation::Law;
  expect_of(act, std::isfinite(control), "its control is not finite");
  expect_of(act, std::isfinite(activation), "its activation is not finite");
  const model::Actuator& a = act.actuator;
  model::Order order{.activation = activation};
  const double u = filtered(a, control, h, order.activation);
  act.order = order;
  if (act.law == Law::none) return;
  expect_there(loop.world(), act, "actuate");
  follow(loop.world(), act);
  if (act.law == Law::force) {
    order.force = force_of(loop.world(), act, u, h / 2);
  } else {
    with_law(
        loop, act, [](auto&) {}, [](auto&) {});  // it is there
    // A cap about its mean, which is a force of its own.
    const double mean = act.law == Law::motor ? (a.force_lower + a.force_upper) / 2 : 0;
    const double drive = a.gain * u + a.bias[0] - mean, stiffness = stiffness_of(a), damping = damping_of(a);
    const double side = act.is_tendon ? 1 : act.parts[0].coefficient;  // ±1: to the coordinate of a joint
    order.rest = side * (stiffness > 0 ? a.gear[0] * drive / stiffness - act.offset : 0);
    order.speed = side * (stiffness > 0 ? 0 : a.gear[0] * drive / damping);
    order.force = act.law == Law::spring && !(stiffness > 0) ? drive : mean;
  }
  expect_of(act,
            std::isfinite(order.force * largest_gear(act)) && std::isfinite(order.rest) &&
                std::isfinite(order.speed),
            "its control makes a force that is not finite");
  act.order = order;
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

/// The bodies that the actuator moves, where its loop lets bodies sleep. Bodies that the host switched off
/// stay off.
template <class Loop>
void wake([[maybe_unused]] Loop& loop, [[maybe_unused]] const model::Actuation& act) {
  constexpr bool has_sleepers = requires(RigidBodies::Handle body) { loop.wake(body); };
  constexpr bool has_switches = requires(RigidBodies::Handle body) { loop.switch_off(body); };
  if constexpr (has_sleepers && !has_switches)
    for (const TendonPart& part : act.parts)
      for (const Anchor* end : {&part.a, &part.b})
        if (!end->is_world()) loop.wake(body_of(*end));
}

/// Does what `find_order` has found. A law that is told something new wakes its bodies.
template <class Loop>
void carry_out(Loop& loop, const model::Actuation& act, double h) {
  if (act.law == model::Actuation::Law::none) return;
  const model::Order& order = act.order;
  if (has_law(act)) {
    bool is_new = false;
    const auto tell = [&](double& number, double told) {
      is_new = is_new || number != told;
      number = told;
    };
    with_law(
        loop, act, [&](auto& item) { tell(item.rest, order.rest); },
        [&](auto& item) { tell(item.target, order.rest), tell(item.speed, order.speed); });
    if (is_new) wake(loop, act);
  }
  push_by(loop, act, order.force, h);
}

}  // namespace delassus::inner
