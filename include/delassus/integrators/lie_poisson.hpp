/// Symplectic Euler whose free rotation is a splitting into turns.
#pragma once

#include <delassus/integrators/integrator.hpp>

namespace delassus {

/// v⁺ = v + h M⁻¹ f,  q⁺ = q ⊕ h v⁺, where bodies turn freely by exact turns about three axes of their own
/// (`turn_freely`). Free rotation: second order, |L| to rounding, the energy bounded, no equation to solve;
/// the midpoint rule of the other integrators keeps the energy too. Forces: first order. Takes whatever
/// `SymplecticEuler` takes, contacts included.
struct LiePoisson {
  using plays = role::Integrator;
  using each_block_alone = LiePoisson;
  static constexpr bool takes_masses_alone = true;  ///< A = M

  SystemScale scale(double) const { return {.mass = 1}; }
  void impulse(const auto& set, auto& p, double h) const {
    set.add_forces(p);
    times(p, h);
  }
  void advance(auto& set, double h) const {
    if constexpr (requires { set.advance_by_rotation_splitting(h); })
      set.advance_by_rotation_splitting(h);
    else
      set.advance(h);
  }
};
static_assert(Integrator<LiePoisson>);

}  // namespace delassus
