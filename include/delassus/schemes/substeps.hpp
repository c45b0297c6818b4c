/// One detection and several solves a step.
#pragma once

#include <delassus/core/expect.hpp>
#include <delassus/core/roles.hpp>
#include <delassus/schemes/inner/step_parts.hpp>
#include <delassus/step/plain_step.hpp>

#include <algorithm>

namespace delassus {

/// Detect once, then `count` times Linearize to Advance with h/count. What falls with the step falls as it would with smaller
/// steps, at one detection: the error of the method, joint drift, the mass ratio that sweeps can take. Contacts go with their
/// bodies, with the normals of the start. Loads act over the whole step, kinematic bodies arrive at its end. The sum of the
/// parts is in `impulse` and `contacts`, their worst status, residual, sweeps and joint violation in the report. Listeners hear
/// a stage once a part. Takes every integrator; no activity.
struct Substeps {
  using plays = role::Scheme;
  static constexpr bool takes_whole_steps = true;  ///< read by the checks: suits integrators that make a whole step at once
  static constexpr bool divides_step = true;  ///< read by the checks, which refuse an activity beside it
  template <class P>
  using State = StepParts<typename P::World, typename P::Laws>;
  int count = 4;  ///< parts of a step, at least 1

  void check() const { inner::expect_at_least_one("Substeps: count", count); }
  void run(auto& step) const {
    stage::detect(step);
    auto& parts = step.template state<role::Scheme>();
    parts.begin(step, count);
    Index quarantined = 0;  // of one part: each names the same bodies again
    for (int left = count; left-- > 0;) {
      step.summary.quarantined = 0;
      stage::move(step);
      quarantined = std::max(quarantined, step.summary.quarantined);
      parts.end_part(step, left);
    }
    step.summary.quarantined = quarantined;
  }
};

}  // namespace delassus
