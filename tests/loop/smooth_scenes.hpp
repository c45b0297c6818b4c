/// Scenes without contacts that have closed forms or reference digits, for integrators of whole steps.
#pragma once

#include <delassus/delassus.hpp>

#include <cmath>
#include <utility>

namespace smooth {

using namespace delassus;

/// AC-08: a point of 1 kg on a rigid length of 1 m, released level.
template <class... Policies>
auto pendulum(Policies... policies) {
  AnimationLoop loop{World{RigidBodies{}, Particles{}}, Constraints{DistanceJoint{}}, policies...};
  auto& points = bodies<Particles>(loop.world());
  const auto bob = points.add({.position = {1, 0, 0}, .mass = 1.0});
  loop.add(DistanceJoint::Item{.a = anchor(points, bob), .b = world_anchor({0, 0, 0}), .length = 1});
  return loop;
}
inline Vec3 pendulum_at_ten() { return {0.275087462576117, 0, -0.961419205099125}; }

/// AC-10: two of them, level.
template <class... Policies>
auto double_pendulum(Policies... policies) {
  AnimationLoop loop{World{RigidBodies{}, Particles{}}, Constraints{DistanceJoint{}}, policies...};
  auto& points = bodies<Particles>(loop.world());
  const auto first = points.add({.position = {1, 0, 0}, .mass = 1.0});
  const auto second = points.add({.position = {2, 0, 0}, .mass = 1.0});
  loop.add(DistanceJoint::Item{.a = anchor(points, first), .b = world_anchor({0, 0, 0}), .length = 1});
  loop.add(DistanceJoint::Item{.a = anchor(points, second), .b = anchor(points, first), .length = 1});
  return loop;
}

/// A box on a hinge whose axis is tilted, with another box on a hinge across at its end: nothing in it is
/// flat.
template <class... Policies>
auto spatial(Policies... policies) {
  AnimationLoop loop{World{RigidBodies{}}, Constraints{Hinge{}}, policies...};
  auto& rigid = bodies<RigidBodies>(loop.world());
  const auto first = rigid.add({.position = {0.5, 0, 0}, .mass = 1.0, .shape = Box{1, 0.2, 0.3}});
  const auto second = rigid.add({.position = {1.4, 0, 0}, .mass = 0.7, .shape = Box{0.8, 0.3, 0.1}});
  const Vec3 axis = Vec3(0.3, 1, 0.2).normalized();
  loop.add(Hinge::Item{anchor_at(rigid, first, Vec3::Zero(), frame_along(axis)),
                       world_anchor(Vec3::Zero(), frame_along(axis))});
  const Vec3 across = Vec3(0.5, 0.1, 1).normalized(), middle(1, 0, 0);
  loop.add(Hinge::Item{anchor_at(rigid, first, middle, frame_along(across)),
                       anchor_at(rigid, second, middle, frame_along(across))});
  return loop;
}

/// A rod of 1 m and 1 kg on a pivot, level.
template <class... Policies>
auto rod(Policies... policies) {
  AnimationLoop loop{World{RigidBodies{}}, Constraints{Hinge{}}, policies...};
  auto& rigid = bodies<RigidBodies>(loop.world());
  const auto rod = rigid.add(
      {.position = {0.5, 0, 0}, .mass = 1.0, .inertia = Mat3(Vec3(1e-3, 1.0 / 12, 1.0 / 12).asDiagonal())});
  const auto pivot = loop.add(Hinge::Item{anchor(rigid, rod, {-0.5, 0, 0}, frame_along({0, 1, 0})),
                                          world_anchor(Vec3::Zero(), frame_along({0, 1, 0}))});
  return std::pair{std::move(loop), pivot};
}

/// Where the last body of the last set is.
template <class Loop>
Vec3 end_of(const Loop& loop) {
  const auto& set = loop.world().template set<Loop::WorldType::set_count - 1>();
  return set.pose(set.blocks() - 1).position;
}
template <class Loop>
double energy(const Loop& loop) {
  double sum = 0;
  loop.world().each([&](const auto& set, auto) { sum += kinetic_energy(set) + potential_energy(set); });
  return sum;
}
/// `seconds` of a loop at h.
template <class Loop>
Loop& run(Loop& loop, double seconds, double h) {
  const long n = std::lround(seconds / h);
  for (long k = 0; k < n; ++k) loop.step(h);
  return loop;
}

}  // namespace smooth
