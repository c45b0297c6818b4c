/// Chains of rods and of points on ball joints, for the integrators that hold them.
#pragma once

#include <delassus/delassus.hpp>

#include <algorithm>
#include <cmath>

namespace chains {

using namespace delassus;

/// Rods of 0.2 m and 1 kg on ball joints, `angle` (rad) from the vertical; the last has `ratio` kg more.
template <class... Policies>
auto rods(int links, double ratio, double angle, Policies... policies) {
  AnimationLoop loop{World{RigidBodies{}}, Constraints{BallJoint{}}, policies...};
  auto& rigid = bodies<RigidBodies>(loop.world());
  const double length = 0.2;
  const Vec3 way(std::sin(angle), 0, -std::cos(angle));
  const Quat turned = exponential<double>({0, -angle, 0});
  Anchor end = world_anchor(Vec3::Zero());
  for (int k = 0; k < links; ++k) {
    const double mass = k == links - 1 ? 1 + ratio : 1;
    const auto link =
        rigid.add({.position = (length * (k + 0.5)) * way,
                   .orientation = turned,
                   .mass = mass,
                   .inertia = Mat3(mass * length * length / 12 * Vec3(1, 1, 0.15).asDiagonal())});
    loop.add(BallJoint::Item{end, anchor(rigid, link, {0, 0, 0.5 * length})});
    end = anchor(rigid, link, {0, 0, -0.5 * length});
  }
  return loop;
}

/// AC-10: two points of 1 kg on rods of 1 m without mass, level. The points have 1e-9 kg·m² to be rigid
/// bodies.
template <class... Policies>
auto double_pendulum(Policies... policies) {
  AnimationLoop loop{World{RigidBodies{}}, Constraints{BallJoint{}}, policies...};
  auto& rigid = bodies<RigidBodies>(loop.world());
  const Mat3 inertia = 1e-9 * Mat3::Identity();
  const auto first = rigid.add({.position = {1, 0, 0}, .mass = 1.0, .inertia = inertia});
  const auto second = rigid.add({.position = {2, 0, 0}, .mass = 1.0, .inertia = inertia});
  loop.add(BallJoint::Item{anchor(rigid, first, {-1, 0, 0}), world_anchor(Vec3::Zero())});
  loop.add(BallJoint::Item{anchor(rigid, second, {-1, 0, 0}), anchor(rigid, first)});
  return loop;
}

/// Its place at 1 s: the angles against the vertical of [Verification], AC-10.
inline Vec3 double_pendulum_at_one() {
  const double a = -0.62508769980639062995, b = -1.0345850856800123406;
  return {std::sin(a) + std::sin(b), 0, -std::cos(a) - std::cos(b)};
}

template <class Loop>
double energy(const Loop& loop) {
  const auto& rigid = loop.world().template set<0>();
  return kinetic_energy(rigid) + potential_energy(rigid);
}

/// Where the last body is.
template <class Loop>
Vec3 end_of(const Loop& loop) {
  const auto& rigid = loop.world().template set<0>();
  return rigid.pose(rigid.blocks() - 1).position;
}

}  // namespace chains
