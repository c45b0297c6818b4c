/// The classic of force feedback: a hand presses a tool on a stiff wall. Everything is simulated, so that every run is the same.
#pragma once

#include <delassus/delassus.hpp>
#include <delassus/haptics/haptics.hpp>

#include <algorithm>
#include <cmath>
#include <limits>
#include <vector>

namespace wall {

using namespace delassus;

/// How the force comes to the device: from a tick each millisecond, or from the loop, held until its next step.
enum class Display { ticks, direct };

struct Setting {
  Display display = Display::ticks;
  int step = 33;              ///< ms of a step of the loop
  int age = 0;                ///< ms from the moment a step takes the device's state to the moment it is published
  double stiffness = 1000;    ///< of the coupling, N/m
  double damping = 0.3;       ///< of the coupling, N·s/m
  double friction = 0.8;      ///< of the device, N·s/m; k T/2 + c, the least that makes a frozen map passive
  double wall_friction = 0;   ///< μ of the wall
  double max_force = std::numeric_limits<double>::infinity();  ///< of the motors, N
  int milliseconds = 3000;
};

struct Sample {
  double time, position, force, energy, friction;  ///< s, m, N, J of the observer, J lost to the device's friction
  Status status;
};

constexpr double tick_period = 1e-3, radius = 0.01, reach = 0.03, hand_speed = 0.1;

/// A tool of 50 g, a ball of 1 cm, over the half-space z < 0; the hand goes from 3 cm to the surface at 0.1 m/s, where the
/// ball's centre would be 1 cm too deep, and stays.
inline std::vector<Sample> press(const Setting& setting) {
  // No budget: the time on the wall clock must not enter.
  HapticChannel channel{.budget = std::numeric_limits<double>::infinity()};
  channel.solver.tolerance = 1e-6;
  channel.output.max_force = setting.max_force;
  AnimationLoop loop{World{RigidBodies{}}, Constraints{Contact{Coulomb{.friction = setting.wall_friction}}, VirtualCoupling{}},
                     NativeCollision{.margin = 0.05}, AcceleratedGaussSeidel{.tolerance = 1e-8}, channel};
  auto& rigid = bodies<RigidBodies>(loop.world());
  rigid.gravity.setZero();
  rigid.add_fixed(HalfSpace{});
  const Vec3 start(0, 0, reach);
  const auto tool = rigid.add({.position = start, .mass = 0.05, .shape = Sphere{radius}});
  const auto proxy = rigid.add({.position = start, .motion = Motion::kinematic});
  const auto coupling = loop.add(VirtualCoupling::Item{.a = anchor(rigid, tool), .b = anchor(rigid, proxy),
                                                       .stiffness = setting.stiffness, .damping = setting.damping,
                                                       .angular_stiffness = 1, .angular_damping = 0.01});
  auto& haptics = loop.template channel<HapticChannel>();
  haptics.connect(coupling);

  SimulatedDevice device{.mass = 0.1, .friction = setting.friction, .hand_stiffness = 300, .hand_damping = 2,
                         .position = start, .hand = start};
  PassivityObserver observer;
  std::vector<DeviceState> past;  // at each millisecond
  std::vector<Sample> samples;
  Vec3 direct = Vec3::Zero();
  const double h = tick_period * setting.step;
  for (int n = 0; n < setting.milliseconds; ++n) {
    past.push_back(device.state());
    device.hand_velocity = Vec3(0, 0, device.hand.z() > 1e-9 ? -hand_speed : 0);
    // The step that took the device's state `age` ago is done now.
    const int taken = n - setting.age;
    if (taken >= 0 && taken % setting.step == 0) {
      rigid.move_to(proxy, past[taken].position);
      loop.step(h);
      direct = -loop.impulse(coupling).template head<3>() / h;
      direct *= std::min(1.0, setting.max_force / std::max(direct.norm(), 1e-300));
    }
    const HapticForce answer = haptics.tick(device.state());
    const Vec3 force = setting.display == Display::ticks ? answer.force : direct;
    const Vec3 before = device.position;
    device.advance(force, tick_period);
    observer.add(force, device.position - before);
    samples.push_back({tick_period * (n + 1), device.position.z(), force.z(), observer.energy(), device.lost_to_friction,
                       answer.solve.status});
  }
  return samples;
}

/// Largest minus smallest position of the last second.
inline double swing(const std::vector<Sample>& samples) {
  const auto [low, high] = std::minmax_element(samples.end() - 1000, samples.end(),
                                               [](const auto& a, const auto& b) { return a.position < b.position; });
  return high->position - low->position;
}

}  // namespace wall
