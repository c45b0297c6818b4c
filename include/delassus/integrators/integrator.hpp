/// What an integrator is: how A is mixed, which impulse acts, and how the state moves on.
#pragma once

#include <delassus/core/array.hpp>
#include <delassus/core/roles.hpp>
#include <delassus/rows/body_set.hpp>
#include <delassus/rows/theta.hpp>

#include <concepts>
#include <type_traits>
#include <span>

namespace delassus {

/// The least a body set can be, to check integrators against without naming a real one. Nothing of it is defined.
struct SetProbe {
  using Scalar = double;
  using Velocity = Vec<3>;         ///< of a point
  static constexpr int width = 3;  ///< velocities a block
  /// After the free motion, m/s.
  Array<Velocity> v_free, v_next;  ///< of the end, m/s
  Array<Velocity>& velocity();  ///< of the start, m/s
  void add_forces(std::span<Velocity>) const;
  void add_stiffness_times_velocity(std::span<Velocity>, double) const;  ///< p −= s K v
  void add_mass_times_velocity(std::span<Velocity>, double) const;  ///< p += s M v
  void advance(double);
  void advance_midpoint(double);  ///< q by the mean of v and v_next
};

/// scale(h) mixes A; impulse(set, p, h) makes A (v_free − v) = p; advance(set, h) moves q and v from v_next.
template <class I>
concept Integrator = Plays<I, role::Integrator> &&
    requires(const I integrator, SetProbe& set, Array<Vec<3>>& p, double h) {
      { integrator.scale(h) } -> std::same_as<SystemScale>;       // A = mass M + damping D + stiffness K
      { integrator.impulse(set, p, h) } -> std::same_as<void>;    // p, N·s
      { integrator.advance(set, h) } -> std::same_as<void>;
    };

/// p ← h p: forces become impulses.
void times(auto& p, double h) {
  for (auto& x : p) x *= typename std::remove_cvref_t<decltype(x)>::Scalar(h);
}

namespace inner {

/// p += f(q, v), and all of it times h: N·s.
void kick(const auto& set, auto& p, double h) {
  set.add_forces(p);
  for (const Index b : set.active()) p[b] *= h;
}

}  // namespace inner

}  // namespace delassus
