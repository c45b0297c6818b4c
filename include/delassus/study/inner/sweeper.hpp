/// A study while it runs: which runs it has, which are known, and the measuring of the others.
#pragma once

#include <delassus/core/cmath.hpp>
#include <delassus/core/execution.hpp>
#include <delassus/core/expect.hpp>
#include <delassus/io/progress.hpp>
#include <delassus/study/code_of.hpp>
#include <delassus/study/inner/observed_run.hpp>
#include <delassus/study/references.hpp>
#include <delassus/study/study.hpp>
#include <delassus/study/study_log.hpp>

#include <algorithm>
#include <array>
#include <atomic>
#include <cstddef>
#include <limits>
#include <memory>
#include <mutex>
#include <span>
#include <string>
#include <tuple>
#include <type_traits>
#include <utility>
#include <vector>

namespace delassus::inner {

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

  template <class E>
  Study run(const E& execution) {
    log_ = std::make_unique<StudyLog>(study_.plan.log, study_);
    if (!study_.plan.is_quiet) progress_ = std::make_unique<Progress>(study_.plan.name);
    if (log_->uncertainties())
      keep(*log_->uncertainties());
    else
      find_reference();
    each_run(-1);  // fills the list
    if (!left_.empty() && !has_reference_) find_reference();
    std::atomic<bool> is_over{false};  // a log that cannot be written must not cost the time of all runs
    execution.run(Index(left_.size()), [&](Index task, Index) {
      if (is_over) return;
      try {
        each_run(study_.runs[left_[std::size_t(task)]].number);
      } catch (...) {
        is_over = true;
        throw;
      }
    });
    return std::move(study_);
  }

 private:
  static constexpr std::size_t measure_count = M::count;
  using Seen = std::array<Observation, measure_count>;

  /// Visits the run of this number, or all of them where it is negative.
  void each_run(int wanted) {
    int number = 0;
    const StudyPlan& plan = study_.plan;
    list_.each([&](int combination, const auto&... policies) {
      for (const double tolerance : tolerances_)
        if constexpr ((ChoosesItsSteps<std::remove_cvref_t<decltype(policies)>> || ...)) {
          const double own[] = {accuracy_of(policies...)};
          for (const double accuracy : plan.accuracies.empty() ? std::span<const double>(own) : std::span<const double>(plan.accuracies))
            visit(wanted, number++, combination, tolerance, plan.duration / plan.outputs,
                  with_accuracy(with_tolerance(policies, tolerance), accuracy)...);
        } else {
          for (const double h : plan.steps) visit(wanted, number++, combination, tolerance, h, with_tolerance(policies, tolerance)...);
        }
    });
  }

  template <class... P>
  void visit(int wanted, int number, int combination, double tolerance, double h, const P&... policies) {
    if (wanted < 0)
      list_run(number, combination, tolerance, h, policies...);
    else if (number == wanted)
      measure_listed(number, policies...);
  }

  template <class... P>
  void list_run(int number, int combination, double tolerance, double h, const P&... policies) {
    if (!study_.plan.wants(number)) return;
    std::string code;
    ((code += (code.empty() ? "" : ", ") + code_of(policies)), ...);
    if (const StudyRun* known = log_->find(number, code)) {
      study_.runs.push_back(*known);
      study_.runs.back().combination = combination;
      ++study_.resumed;
      return;
    }
    left_.push_back(study_.runs.size());
    study_.runs.push_back({.number = number,
                           .combination = combination,
                           .code = std::move(code),
                           .tolerance = tolerance,
                           .h = h,
                           .accuracy = accuracy_of(policies...),
                           .errors = std::vector<double>(measure_count, std::numeric_limits<double>::infinity())});
  }

  /// On any thread, others at once.
  template <class... P>
  void measure_listed(int number, const P&... policies) {
    StudyRun& run = *std::find_if(study_.runs.begin(), study_.runs.end(), [&](const StudyRun& r) { return r.number == number; });
    try {
      measure(run, policies...);
    } catch (const InvalidArgument&) {
      run.outcome = Outcome::failed;  // the scene refuses this combination
    }
    const std::lock_guard lock(mutex_);
    log_->keep(run);
    ++done_;
    if (progress_) progress_->show(double(study_.resumed + done_) / double(study_.runs.size()));
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
  std::vector<std::size_t> left_;  ///< places in study_.runs of those to measure
  std::mutex mutex_;               ///< of the log and the progress
  int done_ = 0;
  std::unique_ptr<StudyLog> log_;
  std::unique_ptr<Progress> progress_;
};

}  // namespace delassus::inner
