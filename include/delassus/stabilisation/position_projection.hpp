/// Position projection: overlaps and joint gaps are closed by displacements that never become velocities.
#pragma once

#include <delassus/core/expect.hpp>
#include <delassus/stabilisation/inner/project_position.hpp>
#include <delassus/stabilisation/stabilisation.hpp>

#include <algorithm>

namespace delassus {

/// The velocity solve sees no violation. Afterwards w = A⁻¹ Hᵀ μ with H w + u⁺ + rate · φ/h ≥ 0 (= 0 for joints). It moves
/// the positions by h w, on the same W and with the friction rows locked at μ = 0.
struct PositionProjection {
  using plays = role::Stabilisation;
  template <class Base>
  using stages = inner::ProjectionStages<Base>;
  template <class P>
    requires(P::Laws::pool_count > 0)
  using State = inner::ProjectionState<P>;
  double rate = 0.2;     ///< share of the violation per step, in (0, 1]
  double max_speed = 1;  ///< m/s, of overlaps; joints are closed at any speed

  void check() const {
    inner::expect_number(rate > 0 && rate <= 1, "PositionProjection: rate", rate, "must be in (0, 1]");
    inner::expect_above_zero("PositionProjection: max_speed", max_speed, "m/s");
  }
  double equality(double, double) const { return 0; }
  double penetration(double, double) const { return 0; }
  /// The speed at which an overlap is closed, ≤ 0, m/s.
  double push(double phi, double h) const { return std::max(close(phi, h), -max_speed); }
  /// The same of a joint, of either sign, without a limit.
  double close(double phi, double h) const { return rate * phi / h; }
};
static_assert(Stabilisation<PositionProjection>);

}  // namespace delassus
