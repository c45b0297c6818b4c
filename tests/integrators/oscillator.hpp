/// A particle on a spring without length to the origin: the harmonic oscillator in each axis.
#pragma once

#include <delassus/delassus.hpp>

#include <numbers>
#include <utility>

namespace oscillator {

using namespace delassus;

inline constexpr double omega = 2 * std::numbers::pi;

/// Unit mass, stiffness ω², at (1, 0, 0), at rest, no gravity.
template <class Integrator, class... Scheme>
auto make(Integrator integrator, double rate, Scheme... scheme) {
  AnimationLoop loop{World{Particles{}}, std::move(integrator), scheme...};
  auto& set = bodies<Particles>(loop.world());
  set.gravity.setZero();
  const auto mass = set.add({.position = {1, 0, 0}, .mass = 1.0});
  set.add_spring(mass, Vec3::Zero(), rate * rate, 0, 0.0);
  return std::pair{std::move(loop), mass};
}

}  // namespace oscillator
