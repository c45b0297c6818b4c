/// One detection and several solves a step.
#pragma once

#include <delassus/core/expect.hpp>
#include <delassus/loop/scheme.hpp>
#include <delassus/loop/stages/step_parts.hpp>

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
  template <class World, class Laws, class Rows>
  using Parts = StepParts<World, Laws, Rows>;
  int count = 4;

  void check() const {
    DELASSUS_EXPECT(count >= 1, "Substeps: count " + inner::text(count) + " must be >= 1");
  }
  void run(auto& loop) const {
    using Loop = std::remove_reference_t<decltype(loop)>;
    loop.detect();
    loop.begin_substeps(count);
    for (int left = count; left-- > 0;) {
      if constexpr (Loop::moves_freely) {
        loop.move_freely();
      } else if constexpr (Loop::solves_whole_step) {
        loop.solve_whole_step();
        loop.advance();
      } else {
        inner::linearize_to_build(loop);
        inner::solve_to_advance(loop);
      }
      loop.end_substep(left);
    }
  }
};

}  // namespace delassus
