/// Implicit Euler, one Newton step.
#pragma once

#include <delassus/core/expect.hpp>
#include <delassus/integrators/integrator.hpp>


namespace delassus {

/// (M + h D + h² K) (v⁺ − v) = h (f − h K v),  q⁺ = q ⊕ h v⁺. First order, damps. D + α M + β K stands for D.
/// f and K are taken at the start of the step; exact for linear forces.
struct ImplicitEuler {
  using plays = role::Integrator;
  using each_block_alone = ImplicitEuler;
  double rayleigh_mass = 0;       ///< α, 1/s
  double rayleigh_stiffness = 0;  ///< β, s

  void check() const {
    inner::expect_not_negative("ImplicitEuler: rayleigh_mass", rayleigh_mass, "1/s");
    inner::expect_not_negative("ImplicitEuler: rayleigh_stiffness", rayleigh_stiffness, "s");
  }
  SystemScale scale(double h) const {
    return {.mass = 1 + h * rayleigh_mass, .damping = h, .stiffness = h * (h + rayleigh_stiffness)};
  }
  /// p ← h (f − (h + β) K v − α M v), N·s.
  void impulse(const auto& set, auto& p, double h) const {
    set.add_forces(p);
    if constexpr (requires { set.add_stiffness_times_velocity(p, h); })
      set.add_stiffness_times_velocity(p, h + rayleigh_stiffness);
    if (rayleigh_mass != 0) set.add_mass_times_velocity(p, -rayleigh_mass);
    times(p, h);
  }
  void advance(auto& set, double h) const { set.advance(h); }
};
static_assert(Integrator<ImplicitEuler>);

}  // namespace delassus
