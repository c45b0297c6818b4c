/// Runs a user's scene over policies, tolerances and step sizes, and says what each accuracy costs.
#pragma once

#include <delassus/core/clock.hpp>
#include <delassus/core/execution.hpp>
#include <delassus/core/expect.hpp>
#include <delassus/study/combinations.hpp>
#include <delassus/study/error_measures.hpp>
#include <delassus/study/inner/sweeper.hpp>
#include <delassus/study/references.hpp>
#include <delassus/study/study.hpp>

#include <algorithm>
#include <cstddef>
#include <ctime>
#include <string>
#include <type_traits>

namespace delassus {

/// Processor time of this process, all its threads together. Where other threads work too, take `ThreadClock`
/// of adapters/posix.hpp.
struct ProcessorClock {
  /// s used so far.
  double now() const { return double(std::clock()) / CLOCKS_PER_SEC; }
};
static_assert(Clock<ProcessorClock>);

/// Runs scene(policies...), which returns a loop ready to step, for every combination of `list` at every
/// tolerance and step of `plan`. Every run is measured once, then timed `plan.repeats` times by `clock`,
/// whole steps alone. What fails, is refused, or takes too long stays in the result with its outcome. Throws
/// InvalidArgument for a plan that cannot be run.
///
/// Runs go to the workers of `execution`, each run to one: the scene and the measures are called on several
/// threads at once, and `clock` must tell the time of its own thread, as `ThreadClock` does.
template <class Scene, class... Axes, class... M, class R = References<>, Clock C = ProcessorClock, Execution E = Serial>
Study sweep(const Scene& scene, const Combinations<Axes...>& list, const StudyPlan& plan,
            const Measures<M...>& measures, const R& references = {}, const C& clock = {}, const E& execution = {}) {
  if constexpr (std::is_same_v<C, ProcessorClock>)
    DELASSUS_EXPECT(execution.workers() == 1, "study '" + plan.name +
                                                  "': ProcessorClock counts all threads together; give `sweep` the "
                                                  "ThreadClock of adapters/posix.hpp where runs share threads");
  return inner::Sweeper<Scene, Combinations<Axes...>, Measures<M...>, R, C>(scene, list, plan, measures,
                                                                            references, clock)
      .run(execution);
}

/// "36 combinations × 3 tolerances × 4 steps = 432 runs, each measured once and timed 3 times": said before a
/// study starts.
template <class... Axes>
std::string announcement(const Combinations<Axes...>&, const StudyPlan& plan) {
  const std::size_t tolerances = std::max<std::size_t>(plan.tolerances.size(), 1);
  std::size_t runs = 0;
  std::string text = plan.name + ":";
  const auto say = [&](int combinations, std::size_t values, const char* of) {
    if (combinations == 0) return;
    text += (runs > 0 ? " + " : " ") + std::to_string(combinations) + " combinations × " + std::to_string(tolerances) +
            " tolerances × " + std::to_string(values) + of;
    runs += std::size_t(combinations) * tolerances * values;
  };
  say(Combinations<Axes...>::fixed, plan.steps.size(), " steps");
  say(Combinations<Axes...>::count - Combinations<Axes...>::fixed, std::max<std::size_t>(plan.accuracies.size(), 1), " accuracies");
  text += " = " + std::to_string(runs) + " runs";
  if (plan.shards > 1)
    text += ", of which shard " + std::to_string(plan.shard) + "/" + std::to_string(plan.shards) +
            " does every " + std::to_string(plan.shards) + "th";
  return text + ", each measured once and timed " + std::to_string(plan.repeats) + " times";
}

}  // namespace delassus
