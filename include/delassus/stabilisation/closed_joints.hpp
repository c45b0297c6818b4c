/// Joints without gaps: what a step of finite turns opens is closed at its end, by displacements alone.
#pragma once

#include <delassus/core/expect.hpp>
#include <delassus/stabilisation/inner/close_gaps.hpp>
#include <delassus/stabilisation/stabilisation.hpp>
#include <delassus/step/moves_at_once.hpp>

#include <algorithm>
#include <type_traits>

namespace delassus {

/// A body that turns by h ω about a joint at the distance r leaves it by r (h ω)²/2, since the joint holds in
/// velocities: as `Baumgarte`, which then leaves r (h ω)²/(2 rate) open. Here Newton's method closes the
/// joints where the step ends,
///
///   q ← q ⊕ w,   w = A⁻¹ Hᵀ μ,   H w = −φ,
///
/// and leaves velocities alone. One pass leaves the square of what was open, over r. Contacts and limits do
/// not see w, and push back in the next step. Sets whose A couples bodies, as soft ones, are left to `rate`.
/// Where a law throws as joints are closed the step is made, with their gaps.
struct ClosedJoints {
  using plays = role::Stabilisation;
  double tolerance = 1e-7;  ///< m, rad, of the gaps that a step leaves
  int max_passes = 4;       ///< of Newton's method
  double rate = 0.2;     ///< share of φ per step, in (0, 1], of overlaps and of what stays open
  double max_speed = 1;  ///< m/s, of overlaps

  /// What closing needs from step to step.
  template <class P>
  requires(P::Laws::pool_count > 0) struct State {
    inner::CloseGaps<P> gaps;  ///< room of Newton's method
  };
  /// Joints are closed where the bodies have moved.
  template <class Base>
  struct stages : Base {
    /// Advance, then close.
    static void advance(auto& step) {
      Base::advance(step);
      using Step = std::remove_reference_t<decltype(step)>;
      if constexpr (inner::some_can_gape(std::type_identity<typename Step::Laws>{}))
        step.template state<role::Stabilisation>().gaps.run(step, step.stabilisation().tolerance,
                                                            step.stabilisation().max_passes);
    }
  };

  void check() const {
    inner::expect_at_least_zero("ClosedJoints: tolerance", tolerance);
    inner::expect_at_least_zero("ClosedJoints: max_passes", max_passes);
    inner::expect_number(rate > 0 && rate <= 1, "ClosedJoints: rate", rate, "must be in (0, 1]");
    inner::expect_above_zero("ClosedJoints: max_speed", max_speed, "m/s");
  }
  double equality(double phi, double h) const { return rate * phi / h; }
  double penetration(double phi, double h) const { return std::max(rate * phi / h, -max_speed); }
};
static_assert(Stabilisation<ClosedJoints>);

}  // namespace delassus
