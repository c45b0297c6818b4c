/// Symplectic Euler: forces at the start of the step, positions with the new velocity.
#pragma once

#include <delassus/integrators/integrator.hpp>

namespace delassus {

/// v⁺ = v + h M⁻¹ f,  q⁺ = q ⊕ h v⁺,  A = M. First order, symplectic; stable for h ω < 2.
struct SymplecticEuler {
  using plays = role::Integrator;
  using each_block_alone = SymplecticEuler;
  static constexpr bool takes_masses_alone = true;  ///< A = M

  SystemScale scale(double) const { return {.mass = 1}; }
  void impulse(const auto& set, auto& p, double h) const { inner::kick(set, p, h); }  ///< p ← h f, N·s
  void advance(auto& set, double h) const { set.advance(h); }
};
static_assert(Integrator<SymplecticEuler>);

}  // namespace delassus
