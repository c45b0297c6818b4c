/// Defines machine_in.hpp, for machine_in_<laws>.cpp.
#pragma once

#include "loop_of.hpp"  // before all else

#include "machine_in.hpp"

#include <delassus/model/actuators.hpp>
#include <delassus/model/add.hpp>
#include <delassus/model/joint_state.hpp>

#include <type_traits>

namespace delassus_run {

template <class Scene>
Machine MachineIn<Scene>::put(const Scene& scene, const Model& model, const Pose& pose, Base base, bool has_one_friction) {
  return add(scene, model, pose, base, LeaveOut{.surfaces = has_one_friction});
}

template <class Scene>
void MachineIn<Scene>::drive(const Scene& scene, Machine& machine, double h) {
  actuate(scene, machine, h);
}

template <class Scene>
void MachineIn<Scene>::place(const Scene& scene, Machine& machine, JointSpace& space, std::span<const double> q, std::span<const double> v) {
  set_joint_state(scene, machine, space, q, v);
}

template <class Scene>
void MachineIn<Scene>::read(const Scene& scene, const Machine& machine, JointReader& reader, std::span<double> q, std::span<double> v) {
  reader.read(scene, machine, q, v);
}

/// The first link at an end that moves, or else at the other; −1: none.
inline Index link_at(const Machine& machine, const Anchor& end, const Anchor& other) {
  for (const Anchor& anchor : {end, other})
    for (std::size_t b = 0; b < machine.parts.size() && !anchor.is_world(); ++b)
      if (!machine.parts[b].is_world && machine.parts[b].body.index == anchor.block) return Index(b);
  return -1;
}

/// The ends of the i-th item of a pool.
struct Ends {
  const Anchor &a, &b;
};
using EndsOf = Ends (*)(const void* pool, Index i);

/// Names the joints of one law.
inline void name_joints(AuditReport& report, const std::string& law, const Slots& slots, const Machine& machine, const Names& names,
                        const void* pool, EndsOf ends_of) {
  for (EffectUse& use : report.uses)
    if (use.effect == Effect::joint && use.name == law)
      for (std::size_t i = 0; i < slots.active().size(); ++i)
        if (int(slots.active()[i]) == use.place) {
          const Ends ends = ends_of(pool, Index(i));
          const Index link = link_at(machine, ends.b, ends.a);
          use.name += " of " + (link < 0 ? "the world" : names.joints[std::size_t(link)]);
          break;
        }
}

template <class Scene>
void MachineIn<Scene>::name_uses(const Scene& scene, const Machine& machine, const Names& names, AuditReport& report) {
  each_pool(scene.laws(), [&]<class Law>(auto, const Pool<Law>& pool) {
    if constexpr (requires { pool.item(0).a; })
      name_joints(report, inner::type_text<Law>(), pool.slots, machine, names, &pool, [](const void* of, Index i) {
        const auto& item = static_cast<const Pool<Law>*>(of)->item(i);
        return Ends{item.a, item.b};
      });
  });
  const RigidBodies& set = bodies<RigidBodies>(scene.world());
  for (EffectUse& use : report.uses)
    for (std::size_t b = 0; use.effect == Effect::body && b < machine.parts.size(); ++b)
      if (!machine.parts[b].is_world && use.name == set.who(machine.parts[b].body.index)) {
        use.name = names.links[b];
        break;
      }
}

}  // namespace delassus_run
