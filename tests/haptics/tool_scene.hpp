/// A tool, a device that leads it, and a path: what the tests of the haptic channel run.
#pragma once

#include <delassus/delassus.hpp>
#include <delassus/haptics/haptic_channel.hpp>

#include <type_traits>
#include <utility>

namespace tool_scene {

using namespace delassus;

inline constexpr double h = 0.02;

/// A tool led by a device, above the ground, with a ball in its way. Round bodies touch in single points, so that the impulses
/// are unique.
template <class Set>
struct Scene {
  static auto make(BasicHapticChannel<AcceleratedGaussSeidel, ScriptedClock> channel) {
    return AnimationLoop{World{Set{}}, Constraints{Contact{Coulomb{.friction = 0.4}}, VirtualCoupling{}},
                         NativeCollision{.margin = 0.05},
                         AcceleratedGaussSeidel{.tolerance = std::is_same_v<Set, RigidBodies> ? 1e-12 : 1e-6,
                                                .max_iterations = 100000},
                         channel};
  }
  static constexpr double k = 800, c = 2, kt = 2, ct = 0.05, mass = 0.05;
  double time = 0;
  BasicHapticChannel<AcceleratedGaussSeidel, ScriptedClock> channel{
      .solver{.tolerance = 1e-12, .max_iterations = 10000}, .budget = 1, .clock{&time, 0}};
  decltype(make(std::declval<BasicHapticChannel<AcceleratedGaussSeidel, ScriptedClock>>())) loop;
  typename Set::Handle tool{}, device{};
  ConstraintHandle<VirtualCoupling> coupling{};

  explicit Scene(const Vec3& place, double tick = 0, double budget = 1)
      : loop([&] {
          channel.clock.tick = tick;
          channel.budget = budget;
          return make(channel);
        }()) {
    auto& set = bodies<Set>(loop.world());
    set.add_fixed(HalfSpace{});
    tool = set.add({.position = place, .mass = mass, .shape = Sphere{0.01}});
    device = set.add({.position = place, .motion = Motion::kinematic});
    set.add({.position = {0.05, 0, 0.03}, .mass = 0.2, .shape = Sphere{0.03}});
    coupling = loop.add(VirtualCoupling::Item{anchor(set, tool), anchor(set, device), k, c, kt, ct});
    haptics().connect(coupling);
  }
  auto& set() { return bodies<Set>(loop.world()); }
  auto& haptics() { return loop.template channel<BasicHapticChannel<AcceleratedGaussSeidel, ScriptedClock>>(); }

  Vec3 half_stretch = Vec3::Zero();
  void step(const Vec3& x, const Quat& q = Quat::Identity()) {
    half_stretch = 0.5 * (set().position(tool) - set().position(device));
    set().move_to(device, x, q);
    loop.step(h);
  }
  /// What the device is told by the loop's own solve; the rows act half a stretch away from it.
  Vec<6> force() {
    Vec<6> f = -loop.impulse(coupling) / h;
    f.template tail<3>() += half_stretch.cross(f.template head<3>());
    return f;
  }
};

/// A path that comes down on the ground, leans on the ball and turns.
inline Vec3 path(int n) { return {0.0006 * n, 0.0002 * n, 0.03 - 0.0008 * n}; }
inline Quat turn(int n) { return exponential<double>(Vec3(0.002 * n, -0.001 * n, 0.003 * n)); }

/// What the loop takes for the state of the device when it goes from pose n to a pose m ahead in one step.
inline DeviceState arrival(int n, int m) {
  const Quat from = turn(n), to = turn(m);
  return {path(m), to, (path(m) - path(n)) / h, logarithm<double>(to * from.conjugate()) / h};
}

}  // namespace tool_scene
