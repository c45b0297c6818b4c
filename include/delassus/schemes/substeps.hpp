/// One detection and several solves a step.
#pragma once

#include <delassus/core/expect.hpp>
#include <delassus/core/roles.hpp>
#include <delassus/schemes/inner/step_parts.hpp>
#include <delassus/step/plain_step.hpp>

#include <algorithm>

namespace delassus {

/// Detect once, then `count` times Linearize to Advance with h/count: what falls with the step (the error of
/// the method, joint drift, the mass ratio that sweeps can take) falls as it would with smaller steps, at one
/// detection. Contacts go with their bodies, with the normals of the start. Loads act over the whole step,
/// kinematic bodies arrive at its end; `impulse` and `contacts` have the sum of the parts, the report the
/// worst status, residual, sweeps and joint violation of them. Listeners hear a stage once a part. Takes
/// every integrator; no activity.
struct Substeps {
  using plays = role::Scheme;
  static constexpr bool takes_whole_steps = true;
  static constexpr bool divides_step = true;
  template <class P>
  using State = StepParts<typename P::World, typename P::Laws>;
  int count = 4;

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
