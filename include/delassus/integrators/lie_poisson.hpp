/// Symplectic Euler whose free rotation is a splitting into turns.
#pragma once

#include <delassus/integrators/symplectic_euler.hpp>

namespace delassus {

/// v⁺ = v + h M⁻¹ f,  q⁺ = q ⊕ h v⁺, where bodies turn freely by exact turns about three axes of their own
/// (`turn_freely`). Free rotation: second order, |L| to rounding, the energy bounded, no equation to solve;
/// the midpoint rule of the other integrators keeps the energy too. Forces: first order. Takes whatever
/// `SymplecticEuler` takes, contacts included.
struct LiePoisson : SymplecticEuler {
  using each_block_alone = LiePoisson;

  void advance(auto& set, double h) const {
    if constexpr (requires { set.advance_by_rotation_splitting(h); })
      set.advance_by_rotation_splitting(h);
    else
      set.advance(h);
  }
};
static_assert(Integrator<LiePoisson>);

}  // namespace delassus
