/// Defines machine_in.hpp, for <type>_machine.cpp.
#pragma once

#include "loop_of.hpp"  // before all else

#include "machine_in.hpp"

#include <delassus/model/actuators.hpp>
#include <delassus/model/add.hpp>
#include <delassus/model/joint_state.hpp>

#include <type_traits>

namespace delassus_run {

template <class Loop>
Machine MachineIn<Loop>::put(Loop& loop, const Model& model, const Pose& pose, Base base, bool has_one_friction) {
  return add(loop, model, pose, base, LeaveOut{.surfaces = has_one_friction});
}

template <class Loop>
void MachineIn<Loop>::drive(Loop& loop, Machine& machine, double h) {
  actuate(loop, machine, h);
}

template <class Loop>
void MachineIn<Loop>::place(Loop& loop, Machine& machine, JointSpace& space, std::span<const double> q, std::span<const double> v) {
  set_joint_state(loop, machine, space, q, v);
}

template <class Loop>
void MachineIn<Loop>::read(const Loop& loop, const Machine& machine, JointReader& reader, std::span<double> q, std::span<double> v) {
  reader.read(loop, machine, q, v);
}

/// The first link at an end that moves, or else at the other; −1: none.
inline Index link_at(const Machine& machine, const Anchor& end, const Anchor& other) {
  for (const Anchor& anchor : {end, other})
    for (std::size_t b = 0; b < machine.parts.size() && !anchor.is_world(); ++b)
      if (!machine.parts[b].is_world && machine.parts[b].body.index == anchor.block) return Index(b);
  return -1;
}

template <class Loop>
AuditReport MachineIn<Loop>::audit(const Loop& loop, const Machine& machine, const Names& names) {
  AuditReport report = loop.template get<AuditWhereAsked>().audit.report();
  each_pool(loop.data().laws(), [&](auto, const auto& pool) {
    const std::string law = inner::type_text<std::remove_cvref_t<decltype(pool.law)>>();
    if constexpr (requires { pool.slots; pool.item(0).a; })
      for (EffectUse& use : report.uses)
        if (use.effect == Effect::joint && use.name == law)
          for (Index i = 0; i < pool.count(); ++i)
            if (int(pool.slots.active()[std::size_t(i)]) == use.place) {
              const Index link = link_at(machine, pool.item(i).b, pool.item(i).a);
              use.name += " of " + (link < 0 ? "the world" : names.joints[std::size_t(link)]);
            }
  });
  const RigidBodies& set = bodies<RigidBodies>(loop.world());
  for (EffectUse& use : report.uses)
    for (std::size_t b = 0; use.effect == Effect::body && b < machine.parts.size(); ++b)
      if (!machine.parts[b].is_world && use.name == set.who(machine.parts[b].body.index)) {
        use.name = names.links[b];
        break;
      }
  return report;
}

}  // namespace delassus_run
