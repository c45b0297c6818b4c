/// Several steps in one.
#pragma once

#include <delassus/core/expect.hpp>
#include <delassus/core/roles.hpp>
#include <delassus/schemes/inner/step_parts.hpp>
#include <delassus/step/plain_step.hpp>

namespace delassus {

/// `count` times Detect to Advance with h/count. What falls with the step falls as it would with smaller steps: the error of the
/// method, joint drift, the mass ratio that sweeps can take. To the host they are one: loads act over the whole step, kinematic
/// bodies arrive at its end, the sum of the parts is in `impulse` and `contacts`, and their worst status, residual, sweeps and
/// violations in the report. Listeners hear a stage once a part. Takes every integrator; no activity. Where a law throws,
/// the parts before it stand: the clock says their end, and loads go on acting.
struct Substeps {
  using plays = role::Scheme;
  static constexpr bool takes_whole_steps = true;  ///< read by the checks: suits integrators that make a whole step at once
  static constexpr bool divides_step = true;  ///< read by the checks, which refuse an activity beside it
  template <class P>
  using State = StepParts<typename P::World, typename P::Laws>;
  int count = 4;  ///< parts of a step, at least 1

  void check() const { inner::expect_at_least_one("Substeps: count", count); }
  void run(auto& step) const {
    auto& parts = step.template state<role::Scheme>();
    parts.begin(step, count);
    for (int left = count; left-- > 0;) {
      stage::detect(step);
      stage::move(step);
      parts.end_part(step, left);
    }
  }
};

}  // namespace delassus
