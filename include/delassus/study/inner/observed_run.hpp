/// One run of a study with its measures looking on, and what a study sets in policies.
#pragma once

#include <delassus/core/roles.hpp>
#include <delassus/core/status.hpp>
#include <delassus/study/combinations.hpp>
#include <delassus/study/error_measures.hpp>
#include <delassus/study/study.hpp>

#include <array>
#include <cstddef>
#include <type_traits>

namespace delassus::inner {

template <class P>
P with_tolerance(P policy, double tolerance) {
  if constexpr (requires { policy.tolerance; })
    if (tolerance >= 0) policy.tolerance = tolerance;
  return policy;
}

template <class P>
P with_accuracy(P policy, double accuracy) {
  if constexpr (ChoosesItsSteps<P>)
    if (accuracy > 0) policy.accuracy = accuracy;
  return policy;
}

/// The accuracy that one of them keeps; -1 where none does.
template <class... P>
double accuracy_of(const P&... policies) {
  double accuracy = -1;
  const auto look = [&](const auto& policy) {
    if constexpr (ChoosesItsSteps<std::remove_cvref_t<decltype(policy)>>) accuracy = policy.accuracy;
  };
  (look(policies), ...);
  return accuracy;
}

template <class P>
concept ChoosesItsStepsToo = ChoosesItsSteps<std::remove_cvref_t<P>>;

/// What a run showed of itself while it was measured.
template <std::size_t measures>
struct Observed {
  std::array<Observation, measures> seen{};
  double sweeps = 0;
  long steps = 0, inner_steps = 0, repeated = 0, capped_steps = 0;
  bool is_lost = false, is_too_slow = false;
};

/// One run with every measure looking on; stops where the scene is lost or the time is up.
template <class Loop, class... M, class C>
Observed<sizeof...(M)> observed(Loop& loop, const Measures<M...>& measures, long between, int outputs, double h,
                          double max_seconds, const C& clock) {
  Observed<sizeof...(M)> t;
  const double start = clock.now();
  measures.each([&](const auto& m, std::size_t k) { m.begin(loop, t.seen[k]); });
  for (int output = 0; output < outputs; ++output) {
    for (long i = 0; i < between; ++i) {
      const StepReport report = loop.step(h);
      ++t.steps;
      t.sweeps += report.sweeps;
      if constexpr (requires { { loop.data().template policy<role::Scheme>() } -> ChoosesItsStepsToo; }) {
        t.inner_steps += error_report(loop).steps;
        t.repeated += error_report(loop).rejections;
      }
      t.capped_steps += report.status != Status::converged && report.status != Status::stalled;
      t.is_lost = report.status == Status::quarantined;
      t.is_too_slow = !t.is_lost && clock.now() - start > max_seconds;
      if (t.is_lost || t.is_too_slow) return t;
      measures.each([&](const auto& m, std::size_t k) { m.step(report, t.seen[k]); });
    }
    measures.each([&](const auto& m, std::size_t k) { m.output(loop, t.seen[k]); });
  }
  return t;
}

/// What the exact functions say at the outputs; empty where a measure has none.
template <class... M>
std::array<Observation, sizeof...(M)> exact_observations(const Measures<M...>& measures,
                                                         const StudyPlan& plan) {
  std::array<Observation, sizeof...(M)> exact{};
  measures.each([&](const auto& m, std::size_t k) {
    if constexpr (std::remove_cvref_t<decltype(m)>::has_exact)
      for (int output = 0; output <= plan.outputs; ++output)
        observe(exact[k], m.exact(plan.duration * output / plan.outputs));
  });
  return exact;
}

}  // namespace delassus::inner
