/// Scenes without contacts that have closed forms or reference digits, for integrators of whole steps.
#pragma once

#include <delassus/delassus.hpp>

#include <array>
#include <cmath>
#include <cstddef>
#include <limits>
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

/// sn, cn and dn of u by Gauss' descending transformation. Source: docs/references.md, [DLMF], 22.20(ii).
inline std::array<double, 3> jacobi(double u, double k) {
  std::array<double, 12> a{1}, c{k};
  double b = std::sqrt(1 - k * k);
  int n = 0;
  for (; n < 11 && std::abs(c[std::size_t(n)]) > 1e-17; ++n) {
    a[std::size_t(n + 1)] = 0.5 * (a[std::size_t(n)] + b);
    c[std::size_t(n + 1)] = 0.5 * (a[std::size_t(n)] - b);
    b = std::sqrt(a[std::size_t(n)] * b);
  }
  double phi = std::ldexp(a[std::size_t(n)] * u, n);
  for (; n > 0; --n) phi = 0.5 * (phi + std::asin(c[std::size_t(n)] / a[std::size_t(n)] * std::sin(phi)));
  return {std::sin(phi), std::cos(phi), std::sqrt(1 - k * k * std::sin(phi) * std::sin(phi))};
}

/// Where the bob of `pendulum` is: sin(θ/2) = k cn/dn of √g t, k = sin 45°.
inline Vec3 pendulum_at(double t) {
  const auto [sn, cn, dn] = jacobi(std::sqrt(9.81) * t, std::sqrt(0.5));
  const double half = std::sqrt(0.5) * cn / dn;
  return {2 * half * std::sqrt(1 - half * half), 0, 2 * half * half - 1};
}

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

/// The largest force of its pivot (N) within 0.6 s, in which it passes its lowest place.
template <class Loop, class Pivot>
double largest_force(Loop& loop, const Pivot& pivot, double h) {
  double most = 0;
  for (long n = std::lround(0.6 / h); n > 0; --n) {
    loop.step(h);
    most = std::max(most, loop.impulse(pivot).norm() / h);
  }
  return most;
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
/// `spatial` when a force is no number: all bodies stay for the step that says so, and go on in the next.
template <class Integrator>
bool leaves_what_is_no_number(Integrator integrator) {
  auto loop = spatial(integrator);
  auto& rigid = bodies<RigidBodies>(loop.world());
  loop.step(0.01);
  const Vec3 before = end_of(loop);
  rigid.apply_force(rigid.handle(0), {std::numeric_limits<double>::quiet_NaN(), 0, 0});
  const bool is_told = loop.step(0.01).status == Status::quarantined;
  const bool has_stayed = (end_of(loop) - before).norm() == 0;
  return is_told && has_stayed && loop.step(0.01).status == Status::converged &&
         (end_of(loop) - before).norm() > 0;
}
/// `spatial` with its first body on a second hinge to the world, a tenth of a metre from where it is: its
/// state stays through steps that say so, and it swings on when the hinge goes.
template <class Integrator>
bool leaves_contradictions(Integrator integrator) {
  auto loop = spatial(integrator);
  const auto& rigid = loop.world().template set<0>();
  loop.step(0.01);
  const Quat axis = frame_along(Vec3(0.3, 1, 0.2));
  const auto wrong = loop.add(Hinge::Item{anchor_at(rigid, rigid.handle(0), Vec3(0.5, 0, 0), axis),
                                          world_anchor({0.5, 0.1, 0}, axis)});
  const Vec3 place = rigid.pose(0).position, velocity = rigid.velocity(rigid.handle(0));
  bool is_well = velocity.norm() > 0.01;
  for (int n = 0; n < 3; ++n) {
    const StepReport report = loop.step(0.01);
    is_well = is_well && report.status == Status::infeasible && report.quarantined == 0;
    is_well = is_well && (rigid.pose(0).position - place).norm() == 0 &&
              (rigid.velocity(rigid.handle(0)) - velocity).norm() == 0;
  }
  loop.remove(wrong);
  is_well = is_well && loop.step(0.01).status <= Status::stalled;
  return is_well && (rigid.pose(0).position - place).norm() > 0;
}
/// `seconds` of a loop at h.
template <class Loop>
Loop& run(Loop& loop, double seconds, double h) {
  const long n = std::lround(seconds / h);
  for (long k = 0; k < n; ++k) loop.step(h);
  return loop;
}

}  // namespace smooth
