/// Runs a user's scene over policies, tolerances and step sizes, and says what each accuracy costs.
#pragma once

#include <delassus/core/clock.hpp>
#include <delassus/core/cmath.hpp>
#include <delassus/core/status.hpp>
#include <delassus/core/roles.hpp>
#include <delassus/io/progress.hpp>
#include <delassus/study/combinations.hpp>
#include <delassus/study/error_measures.hpp>
#include <delassus/study/references.hpp>
#include <delassus/study/study.hpp>
#include <delassus/study/study_log.hpp>

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdio>
#include <ctime>
#include <limits>
#include <memory>
#include <span>
#include <string>
#include <tuple>
#include <type_traits>
#include <utility>
#include <vector>

namespace delassus {

/// Processor time of this process, all its threads together. Where other threads work too, take `ThreadClock`
/// of adapters/posix.hpp.
struct ProcessorClock {
  /// s used so far.
  double now() const { return double(std::clock()) / CLOCKS_PER_SEC; }
};
static_assert(Clock<ProcessorClock>);

namespace inner {

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

inline double median(std::vector<double> values) {
  std::sort(values.begin(), values.end());
  const std::size_t n = values.size();
  return n % 2 == 1 ? values[n / 2] : 0.5 * (values[n / 2 - 1] + values[n / 2]);
}

/// A study while it runs.
template <class Scene, class List, class M, class R, class C>
class Sweeper {
 public:
  Sweeper(const Scene& scene, const List& list, const StudyPlan& plan, const M& measures, const R& references,
          const C& clock)
      : scene_(scene), list_(list), measures_(measures), references_(references), clock_(clock) {
    plan.check();
    study_.plan = plan;
    study_.combinations = List::count;
    study_.fixed = List::fixed;
    study_.axes = list.names();
    measures.each([&](const auto& m, std::size_t) { study_.measures.push_back({m.name, m.unit}); });
    tolerances_ = plan.tolerances.empty() ? std::vector<double>{-1} : plan.tolerances;
    if (plan.only >= 0)
      DELASSUS_EXPECT(plan.only < study_.run_count(), "study '" + plan.name + "': there is no run " +
                                                          std::to_string(plan.only) + " among " +
                                                          std::to_string(study_.run_count()));
  }

  Study run() {
    log_ = std::make_unique<StudyLog>(study_.plan.log, study_);
    if (!study_.plan.is_quiet) progress_ = std::make_unique<Progress>(study_.plan.name);
    if (log_->uncertainties())
      keep(*log_->uncertainties());
    else
      find_reference();
    int number = 0;
    const StudyPlan& plan = study_.plan;
    list_.each([&](int combination, const auto&... policies) {
      for (const double tolerance : tolerances_)
        if constexpr ((ChoosesItsSteps<std::remove_cvref_t<decltype(policies)>> || ...)) {
          const double own[] = {accuracy_of(policies...)};
          for (const double accuracy : plan.accuracies.empty() ? std::span<const double>(own) : std::span<const double>(plan.accuracies))
            visit(number++, combination, tolerance, plan.duration / plan.outputs,
                  with_accuracy(with_tolerance(policies, tolerance), accuracy)...);
        } else {
          for (const double h : plan.steps) visit(number++, combination, tolerance, h, with_tolerance(policies, tolerance)...);
        }
    });
    return std::move(study_);
  }

 private:
  static constexpr std::size_t measure_count = M::count;
  using Seen = std::array<Observation, measure_count>;

  template <class... P>
  void visit(int number, int combination, double tolerance, double h, const P&... policies) {
    if (!study_.plan.wants(number)) return;
    std::string code;
    ((code += (code.empty() ? "" : ", ") + code_of(policies)), ...);
    if (const StudyRun* known = log_->find(number, code)) {
      study_.runs.push_back(*known);
      study_.runs.back().combination = combination;
      ++study_.resumed;
    } else {
      if (!has_reference_) find_reference();
      StudyRun run{.number = number,
                   .combination = combination,
                   .code = std::move(code),
                   .tolerance = tolerance,
                   .h = h,
                   .accuracy = accuracy_of(policies...),
                   .errors = {}};
      run.errors.assign(measure_count, std::numeric_limits<double>::infinity());
      try {
        measure(run, policies...);
      } catch (const InvalidArgument&) {
        run.outcome = Outcome::failed;  // the scene refuses this combination
      }
      log_->keep(run);
      study_.runs.push_back(std::move(run));
    }
    if (progress_) progress_->show(double(number + 1) / study_.run_count());
  }

  template <class... P>
  void measure(StudyRun& run, const P&... policies) {
    const StudyPlan& plan = study_.plan;
    const long between = plan.steps_between_outputs(run.h);
    auto loop = scene_(policies...);
    const auto seen = observed(loop, measures_, between, plan.outputs, run.h, plan.max_seconds, clock_);
    run.steps = seen.steps;
    run.inner_steps = seen.inner_steps;
    run.repeated = seen.repeated;
    run.sweeps = seen.sweeps;
    run.capped_steps = seen.capped_steps;
    bool is_finite = !seen.is_lost;
    if (is_finite && !seen.is_too_slow)
      measures_.each([&](const auto& m, std::size_t k) {
        run.errors[k] = m.error(seen.seen[k], reference_[k]);
        is_finite = is_finite && std::isfinite(run.errors[k]);
      });
    run.outcome = !is_finite             ? Outcome::failed
                  : seen.is_too_slow     ? Outcome::too_slow
                  : run.capped_steps > 0 ? Outcome::capped
                                         : Outcome::sound;
    run.cost = run.least_cost = plan.max_seconds;
    if (run.outcome == Outcome::too_slow) return;
    std::vector<double> costs;
    for (int k = 0; k < plan.repeats; ++k) costs.push_back(time_of(run, policies...));
    run.cost = median(costs);
    run.least_cost = *std::min_element(costs.begin(), costs.end());
  }

  /// The steps of one run by the clock: as many as were measured, so a lost run costs what it took to get
  /// lost.
  template <class... P>
  double time_of(const StudyRun& run, const P&... policies) const {
    auto loop = scene_(policies...);
    const double start = clock_.now();
    for (long i = 0; i < run.steps; ++i) loop.step(run.h);
    return clock_.now() - start;
  }

  /// The observations all runs are compared with, and by how much the references differ.
  void find_reference() {
    reference_ = exact_observations(measures_, study_.plan);
    const std::size_t outputs = std::size_t(study_.plan.outputs);
    std::vector<double> uncertainties(measure_count * outputs, 0);
    if constexpr (M::needs_reference) {
      static_assert(R::count >= 2,
                    "delassus: a measure without exact(t) needs References{refined(...), refined(...)} of "
                    "two integrators");
      const double finest = *std::min_element(study_.plan.steps.begin(), study_.plan.steps.end());
      bool is_first = true;
      const auto one = [&](const auto& refined) {
        const Seen seen = std::apply(
            [&](const auto&... policy) { return observe_fine(refined.refinement, finest, policy...); },
            refined.policies);
        measures_.each([&](const auto& m, std::size_t k) {
          if constexpr (std::remove_cvref_t<decltype(m)>::needs_reference) {
            if (is_first)
              reference_[k] = seen[k];
            else
              for (std::size_t n = 1; n <= outputs; ++n)
                uncertainties[k * outputs + n - 1] =
                    larger(uncertainties[k * outputs + n - 1], m.error(until(seen[k], n), until(reference_[k], n)));
          }
        });
        is_first = false;
      };
      std::apply([&](const auto&... refined) { (one(refined), ...); }, references_.runs);
    }
    if (!log_->uncertainties().has_value()) log_->keep_uncertainties(uncertainties);
    keep(uncertainties);
    has_reference_ = true;
  }

  template <class... P>
  Seen observe_fine(int refinement, double finest, const P&... policies) const {
    auto loop = scene_(policies...);
    const long between = study_.plan.steps_between_outputs(finest) * refinement;
    const auto seen = observed(loop, measures_, between, study_.plan.outputs, finest / refinement,
                            std::numeric_limits<double>::infinity(), clock_);
    DELASSUS_EXPECT(!seen.is_lost,
                    "study '" + study_.plan.name + "': a reference run became non-finite; refine it more");
    return seen.seen;
  }

  /// What was seen up to an output, from 1.
  static Observation until(Observation seen, std::size_t output) {
    seen.values.resize(std::min(seen.values.size(), seen.width * (output + 1)));
    return seen;
  }

  /// By measure, and within it by output.
  void keep(const std::vector<double>& uncertainties) {
    const std::size_t outputs = std::size_t(study_.plan.outputs);
    for (std::size_t k = 0; k < measure_count; ++k) {
      const auto begin = uncertainties.begin() + std::ptrdiff_t(k * outputs);
      study_.measures[k].uncertainty_until.assign(begin, begin + std::ptrdiff_t(outputs));
      study_.measures[k].uncertainty = study_.measures[k].uncertainty_until.back();
    }
  }

  const Scene& scene_;
  const List& list_;
  const M& measures_;
  const R& references_;
  C clock_;
  Study study_;
  std::vector<double> tolerances_;
  Seen reference_{};
  bool has_reference_ =
      false;  ///< its uncertainty may come from the log; the reference itself is made when a run needs it
  std::unique_ptr<StudyLog> log_;
  std::unique_ptr<Progress> progress_;
};

}  // namespace inner

/// Runs scene(policies...), which returns a loop ready to step, for every combination of `list` at every
/// tolerance and step of `plan`. Every run is measured once, then timed `plan.repeats` times by `clock`,
/// whole steps alone. What fails, is refused, or takes too long stays in the result with its outcome. Throws
/// InvalidArgument for a plan that cannot be run.
template <class Scene, class... Axes, class... M, class R = References<>, Clock C = ProcessorClock>
Study sweep(const Scene& scene, const Combinations<Axes...>& list, const StudyPlan& plan,
            const Measures<M...>& measures, const R& references = {}, const C& clock = {}) {
  return inner::Sweeper<Scene, Combinations<Axes...>, Measures<M...>, R, C>(scene, list, plan, measures,
                                                                            references, clock)
      .run();
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
