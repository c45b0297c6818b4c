/// What outlives the parts of a step that is done in several: for `Substeps`.
#pragma once

#include <delassus/bodies/world.hpp>
#include <delassus/rows/row_system.hpp>
#include <delassus/schemes/inner/impulses_of_parts.hpp>
#include <delassus/step/step_report.hpp>

#include <algorithm>
#include <tuple>

namespace delassus {

/// Loads act in every part, kinematic bodies arrive in the last, impulses are those of all parts together.
template <class World, class Laws>
class StepParts {
 public:
  /// From here on h is h/count.
  void begin(auto& step, int count) {
    h_ = step.h, start_ = step.start, steps_ = step.steps;
    step.world().each([&](auto& set, auto s) {
      if constexpr (requires { set.loads(); }) std::get<s>(loads_) = set.loads();
    });
    impulses_.clear();
    counted_ = {};
    stay_on_the_way(step.world(), count > 1);
    step.start = step.time();
    step.steps = 0;
    step.h /= count;
  }
  /// After a part, of which `left` are to come; after the last h is that of the step again.
  void end_part(auto& step, int left) {
    count(step.summary, left);
    impulses_.add(step);
    if (left > 0) {
      step.world().each([&](auto& set, auto s) {
        if constexpr (requires { set.loads(); }) set.loads() = std::get<s>(loads_);
      });
      stay_on_the_way(step.world(), left > 1);
      step.last_h = step.h;
    } else {
      impulses_.give_to(step);
      step.h = h_;
      step.start = start_;
      step.steps = steps_ + 1;
      step.summary.time = step.time();
    }
  }

 private:
  /// Each part names the same bodies again that stay where they are, and asks questions of its own.
  void count(StepReport& summary, int left) {
    counted_.quarantined = std::max(counted_.quarantined, summary.quarantined);
    counted_.queries += summary.queries;
    counted_.rejects += summary.rejects;
    summary.quarantined = left > 0 ? 0 : counted_.quarantined;
    summary.queries = counted_.queries;
    summary.rejects = counted_.rejects;
  }
  /// Kinematic bodies arrive in the last part.
  static void stay_on_the_way(World& world, bool is_on_the_way) {
    world.each([&](auto& set, auto) {
      if constexpr (requires { set.targets(); }) set.targets().stay_on_the_way(is_on_the_way);
    });
  }

  double h_ = 0, start_ = 0;  ///< of the whole step, s
  long steps_ = 0;
  inner::ImpulsesOfParts<Laws> impulses_;
  StepReport counted_;  ///< of the parts so far
  typename World::template PerSet<VelocitiesOf> loads_;
};

}  // namespace delassus
