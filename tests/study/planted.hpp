/// A scene with friction, restitution, a rod and bodies that do nothing.
#pragma once

#include <delassus/delassus.hpp>
#include <delassus/study/audit.hpp>

#include <utility>

namespace planted {

using namespace delassus;

constexpr double h = 1e-2;

template <class Loop>
Loop run(Loop loop, int steps) {
  for (int i = 0; i < steps; ++i) loop.step(h);
  return loop;
}

inline const EffectUse& find(const AuditReport& report, Effect effect, int nth = 0) {
  for (const EffectUse& use : report.uses)
    if (use.effect == effect && nth-- == 0) return use;
  throw InvalidArgument("no such effect in the report");
}

template <class Law>
auto loop_with(Law law) {
  return AnimationLoop{World{RigidBodies{}}, Constraints{Contact{law}, DistanceJoint{}},
                       AcceleratedGaussSeidel{.tolerance = 1e-8}, Audit{}};
}

/// Two boxes rest on the floor, a rod between them at its own length; a third body hangs on a rod and swings.
template <class Law>
auto scene(Law law, bool has_idle_rod) {
  auto loop = loop_with(law);
  auto& rigid = bodies<RigidBodies>(loop.world());
  rigid.add_fixed(HalfSpace{});
  const auto a = rigid.add({.position = {0, 0, 0.5}, .mass = 1.0, .shape = Box{1, 1, 1}});
  const auto b = rigid.add({.position = {2, 0, 0.5}, .mass = 1.0, .shape = Box{1, 1, 1}});
  const auto bob = rigid.add({.position = {1, 5, 4}, .mass = 1.0, .shape = Sphere{0.1}});
  if (has_idle_rod) loop.add(DistanceJoint::Item{.a = anchor(rigid, a), .b = anchor(rigid, b), .length = 2});
  loop.add(DistanceJoint::Item{.a = anchor(rigid, bob), .b = world_anchor({0, 5, 4}), .length = 1});
  return run(std::move(loop), 100);
}

}  // namespace planted
