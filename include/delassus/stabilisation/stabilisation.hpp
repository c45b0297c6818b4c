/// How a violated rigid row is pulled back: φ becomes a rate. Open rows and springs have theirs in step/bias.hpp.
#pragma once

#include <delassus/core/roles.hpp>

#include <concepts>

namespace delassus {

/// equality(φ, h): the bias of a joint's row, m/s. penetration(φ, h), φ < 0: the bias of a contact that overlaps,
/// ≤ 0. A policy that says relative_compliance(h) makes violated contact rows yield by that share of their own W_kk; one that
/// corrects positions and leaves velocities alone overrides Advance, see `PositionProjection`.
template <class S>
concept Stabilisation = Plays<S, role::Stabilisation> && requires(const S policy, double phi, double h) {
  { policy.equality(phi, h) } -> std::same_as<double>;
  { policy.penetration(phi, h) } -> std::same_as<double>;
};

}  // namespace delassus
