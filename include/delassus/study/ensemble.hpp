/// Many worlds of one loop type, each from its own parameters, run from start to end on several threads.
#pragma once

#include <delassus/core/execution.hpp>
#include <delassus/core/index.hpp>
#include <delassus/core/status.hpp>
#include <delassus/io/progress.hpp>
#include <delassus/io/state_hash.hpp>
#include <delassus/loop/why_quarantined.hpp>
#include <delassus/study/ensemble_log.hpp>
#include <delassus/study/ensemble_results.hpp>
#include <delassus/study/inner/failure_of.hpp>
#include <delassus/study/inner/parameters_text.hpp>

#include <atomic>
#include <cstddef>
#include <mutex>
#include <optional>
#include <string>
#include <type_traits>
#include <utility>
#include <vector>

namespace delassus {
namespace inner {

/// The progress line of many threads: steps of all runs. A thread that finds the line taken goes on without it.
class SharedProgress {
 public:
  SharedProgress(const EnsemblePlan& plan, std::size_t runs) : steps_(double(plan.steps) * double(runs)) {
    if (!plan.is_quiet) line_.emplace(plan.name);
  }
  void add(long steps) {
    if (!line_) return;
    done_.fetch_add(steps, std::memory_order_relaxed);
    const std::unique_lock lock(mutex_, std::try_to_lock);
    if (lock) line_->show(double(done_.load(std::memory_order_relaxed)) / steps_);
  }

 private:
  double steps_;
  std::atomic<long> done_{0};
  std::mutex mutex_;
  std::optional<Progress> line_;
};

/// Appends a row; returns how many numbers it has.
template <class Row>
std::size_t append_row(std::vector<double>& values, const Row& row) {
  const std::size_t before = values.size();
  if constexpr (std::is_arithmetic_v<Row>) values.push_back(double(row));
  else
    for (const double x : row) values.push_back(x);
  return values.size() - before;
}

}  // namespace inner

/// `Ensemble{make_loop, parameters}`: make_loop(parameters[i]) returns the loop of run i, ready to step. It is called on several threads at
/// once, and a loop lives as long as its run: there are at most as many as workers. `Batch` has all worlds at once, for steps in turn.
template <class MakeLoop, class P>
class Ensemble {
 public:
  using Loop = std::invoke_result_t<const MakeLoop&, const P&>;  ///< of each run
  static_assert(!std::is_reference_v<Loop>, "delassus: make_loop of an Ensemble must return a new loop, not a reference to one");

  /// Throws InvalidArgument when there are no parameters.
  Ensemble(MakeLoop make_loop, std::vector<P> parameters) : make_loop_(std::move(make_loop)), parameters_(std::move(parameters)) {
    DELASSUS_EXPECT(!parameters_.empty(), "ensemble: the list of parameters is empty; give it those of one run at least");
  }

  /// What run i is made from.
  const std::vector<P>& parameters() const { return parameters_; }

  /// Steps every run that the log does not hold. observe(loop) or observe(loop, parameters) returns a number, or a list of as many as
  /// plan.observations has names; it is called on several threads at once. Each run has the bits that it has alone, whatever the
  /// execution. A run fails when make_loop, a step or observe throws, or when a body is quarantined; its sentence stands in the result,
  /// and the others go on. Throws InvalidArgument for a plan that cannot be run, a log of another ensemble or one that cannot be written.
  template <class Observe, Execution E = Serial>
  EnsembleResults run(const EnsemblePlan& plan, const Observe& observe, const E& execution = {}) const {
    plan.check();
    EnsembleLog log(plan, parameters_.size());
    EnsembleResults results{.plan = plan, .runs = {}};
    std::vector<std::size_t> left;  // places in results.runs
    for (std::size_t i = 0; i < parameters_.size(); ++i) {
      if (!plan.wants(long(i))) continue;
      const std::optional<std::string> text = inner::parameters_text(parameters_[i]);
      DELASSUS_EXPECT(text || !log.is_kept(), "ensemble '" + plan.name + "': its log cannot tell these parameters apart; make them numbers, words, "
                                              "lists of them, or a type with `std::string code() const`");
      const EnsembleRun* known = log.find(long(i), text.value_or(""));
      results.resumed += known != nullptr;
      if (!known) left.push_back(results.runs.size());
      results.runs.push_back(known ? *known : EnsembleRun{.number = long(i), .parameters = text.value_or(""), .width = plan.observations.size()});
    }
    inner::SharedProgress progress(plan, left.size());
    std::mutex mutex;  // of the log
    std::atomic<bool> is_over{false};  // a log that cannot be written must not cost the time of all runs
    execution.run(Index(left.size()), [&](Index task, Index) {
      if (is_over) return;
      EnsembleRun& run = results.runs[left[std::size_t(task)]];
      try {
        run_one(run, plan, observe, progress);
        const std::lock_guard lock(mutex);
        log.keep(run);
      } catch (...) {
        is_over = true;
        throw;
      }
    });
    return results;
  }

 private:
  template <class Observe>
  void run_one(EnsembleRun& run, const EnsemblePlan& plan, const Observe& observe, inner::SharedProgress& progress) const {
    const P& parameters = parameters_[std::size_t(run.number)];
    std::size_t count = run.width;  // of the last row
    std::string lost;
    const std::string thrown = inner::failure_of([&] {
      Loop loop = make_loop_(parameters);
      const auto look = [&] {
        if constexpr (std::is_invocable_v<const Observe&, const Loop&, const P&>)
          count = inner::append_row(run.values, observe(std::as_const(loop), parameters));
        else count = inner::append_row(run.values, observe(std::as_const(loop)));
        return count == run.width;
      };
      if (plan.every > 0 && !look()) return;
      while (run.steps < plan.steps) {
        const auto report = loop.step(plan.h);
        ++run.steps;
        run.capped_steps += report.status != Status::converged && report.status != Status::stalled;
        if (run.steps % 64 == 0) progress.add(64);
        if (report.status == Status::quarantined) {
          lost = why_quarantined(loop);
          return;
        }
        if ((run.steps == plan.steps || (plan.every > 0 && run.steps % plan.every == 0)) && !look()) return;
      }
      run.hash = state_hash(loop);
    });
    DELASSUS_EXPECT(count == run.width, "ensemble '" + plan.name + "': observe returned " + std::to_string(count) + " numbers, but observations names " +
                                            std::to_string(run.width));
    run.failure = inner::field_text(thrown.empty() ? lost : thrown);
    progress.add(plan.steps - run.steps / 64 * 64);
  }

  MakeLoop make_loop_;
  std::vector<P> parameters_;
};

}  // namespace delassus
