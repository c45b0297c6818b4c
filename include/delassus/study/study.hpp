/// What a study is asked, what it found, and the choice of the cheapest run that is accurate enough.
#pragma once

#include <delassus/core/cmath.hpp>
#include <delassus/core/expect.hpp>
#include <delassus/core/status.hpp>
#include <delassus/study/code_of.hpp>

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

namespace delassus {

/// The run-time side of a study. Runs are numbered: combinations, within them tolerances, within them steps or accuracies.
struct StudyPlan {
  std::string name;                  ///< of the scene, for titles
  std::string call = "scene";        ///< how the user's program calls the scene, for the C++ line
  double duration = 1;               ///< s, simulated
  std::vector<double> steps{};       ///< h, s; each divides duration/outputs
  std::vector<double> accuracies{};  ///< in place of steps for combinations with `ErrorControlled`; none: as it says
  std::vector<double> tolerances{};  ///< of the solver; none: as the policies say
  int outputs = 10;                  ///< moments at which a run is compared, evenly spaced, the end included
  int repeats = 3;                   ///< timed runs; the cost is their median
  double max_seconds = 60;           ///< of cost, a run: a longer one is stopped and shown as such
  std::string log{};  ///< file that keeps each finished run; a study that was interrupted goes on from it
  /// From 0 to `shards` − 1.
  int shard = 0, shards = 1;  ///< only runs whose number is `shard` modulo `shards`
  int only = -1;              ///< only the run of this number
  bool is_quiet = false;      ///< no progress line

  void check() const {
    inner::expect_positive("study '" + name + "': duration", duration, "s");
    DELASSUS_EXPECT(outputs > 0, "study '" + name + "': outputs " + std::to_string(outputs) + " must be > 0");
    DELASSUS_EXPECT(repeats > 0, "study '" + name + "': repeats " + std::to_string(repeats) + " must be > 0");
    DELASSUS_EXPECT(shards > 0 && shard >= 0 && shard < shards,
                    "study '" + name + "': shard " + std::to_string(shard) + " must be one of 0 … " +
                        std::to_string(shards - 1));
    DELASSUS_EXPECT(!steps.empty(), "study '" + name + "': steps is empty; name at least one step size");
    for (const double h : steps) steps_between_outputs(h);
    for (const double a : accuracies)
      inner::expect_number(a > 0 && a <= 0.1, "study '" + name + "': accuracy", a, "must be in (0, 0.1]");
    for (const double t : tolerances) inner::expect_not_negative("study '" + name + "': tolerance", t);
  }
  /// Whole steps from one output to the next.
  long steps_between_outputs(double h) const {
    const double count = duration / outputs / h;
    DELASSUS_EXPECT(h > 0 && std::isfinite(h) && std::abs(count - std::round(count)) < 1e-6 && count > 0.5,
                    "study '" + name + "': step " + inner::text(h) +
                        " s must be > 0 and divide duration/outputs = " + inner::text(duration / outputs) +
                        " s");
    return std::lround(count);
  }
  /// Whether this run is to be done here, by `only` or by the shard.
  bool wants(int run) const { return only >= 0 ? run == only : run % shards == shard; }
};

/// How a run ended.
enum class Outcome : std::uint8_t {
  sound,     ///< every step converged
  capped,    ///< finite, but some steps ran out of sweeps
  failed,    ///< not finite, quarantined, or refused by the scene
  too_slow,  ///< stopped at max_seconds
};

/// As diagrams print it.
constexpr const char* name(Outcome outcome) {
  constexpr const char* names[] = {"sound", "capped", "failed", "too slow"};
  return inner::name_in(names, outcome);
}

/// Which runs are asked about.
enum class Stepping : std::uint8_t {
  any,
  fixed,       ///< one step size, chosen by the plan
  controlled,  ///< an accuracy, which chooses the steps
};

/// One combination at one tolerance and one step size or accuracy.
struct StudyRun {
  int number = -1;  ///< from 0, see StudyPlan
  int combination = -1;  ///< from 0, in the order of the list
  std::string code;       ///< its policies as C++
  double tolerance = -1;  ///< of the solver; -1 where the plan names none
  double h = 0;           ///< s; with an accuracy the time between two outputs
  double accuracy = -1;   ///< that was asked of `ErrorControlled`; -1: the steps are fixed
  Outcome outcome = Outcome::failed;  ///< `failed` until it is known
  double cost = 0;        ///< s, median of the repeats, all steps, without set-up
  double least_cost = 0;  ///< s, the smallest of the repeats
  double sweeps = 0;      ///< of all steps: the count that no machine changes
  long steps = 0;  ///< of the loop, up to where it was stopped
  long inner_steps = 0;  ///< that an accuracy took
  long repeated = 0;     ///< trials that it refused
  long capped_steps = 0;       ///< that did not converge
  std::vector<double> errors;  ///< by measure

  /// Whether a policy chose its steps.
  bool is_controlled() const { return accuracy > 0; }
  /// Whether its errors and cost count: sound or capped.
  bool is_usable() const { return outcome == Outcome::sound || outcome == Outcome::capped; }
};

/// A measure and what is known of its reference.
struct StudyMeasure {
  /// For titles.
  std::string name, unit;  ///< of its errors
  double uncertainty = 0;  ///< of the reference; 0 where it is exact or none is needed
  std::vector<double> uncertainty_until{};  ///< the same up to each output; the last is `uncertainty`
};

/// A plan and what its runs showed.
struct Study {
  StudyPlan plan;  ///< as it was given
  int combinations = 0;  ///< how many there are
  int fixed = 0;         ///< of them, those with fixed steps
  std::vector<std::vector<std::string>> axes;  ///< the C++ text of each choice
  std::vector<StudyMeasure> measures;  ///< in the order of the errors of a run
  std::vector<StudyRun> runs;  ///< in the order of their numbers
  int resumed = 0;             ///< of them, read from the log

  /// Of the whole plan, whatever the shard.
  int run_count() const {
    const std::size_t tolerances = std::max<std::size_t>(plan.tolerances.size(), 1), accuracies = std::max<std::size_t>(plan.accuracies.size(), 1);
    return int(tolerances * (std::size_t(fixed) * plan.steps.size() + std::size_t(combinations - fixed) * accuracies));
  }
  /// The number of a measure by name.
  int measure(std::string_view wanted) const {
    for (std::size_t k = 0; k < measures.size(); ++k)
      if (measures[k].name == wanted) return int(k);
    inner::refuse("study '" + plan.name + "': no measure is named '" + std::string(wanted) + "'");
  }
  /// An error below the uncertainty of its reference is not known to be that small.
  bool is_believed(const StudyRun& run, int m) const {
    return run.errors[std::size_t(m)] > measures[std::size_t(m)].uncertainty;
  }
  /// The most the true error can be.
  double error_bound(const StudyRun& run, int m) const {
    return run.errors[std::size_t(m)] + measures[std::size_t(m)].uncertainty;
  }
  /// Which value of each axis a combination has; the last axis varies first.
  std::vector<int> choices(int combination) const {
    std::vector<int> at(axes.size());
    for (std::size_t a = axes.size(); a-- > 0; combination /= int(axes[a].size()))
      at[a] = combination % int(axes[a].size());
    return at;
  }

  /// The time (s) of the last output up to which the references agree to `error` in measure m: beyond it no run is
  /// known to be that accurate. `plan.duration` where they always do; 0 where they never do.
  double horizon(int m, double error) const {
    const std::vector<double>& until = measures[std::size_t(m)].uncertainty_until;
    std::size_t good = 0;
    while (good < until.size() && until[good] <= error) ++good;
    return good == until.size() ? plan.duration : plan.duration * double(good) / plan.outputs;
  }

  /// The cheapest run whose error bound in measure m is within `budget`; null where there is none. Of two
  /// that cost the same the more accurate, then the first.
  const StudyRun* cheapest(int m, double budget, Stepping stepping = Stepping::any) const {
    const StudyRun* best = nullptr;
    for (const StudyRun& run : runs) {
      if (!run.is_usable() || !is_of(run, stepping) || !(error_bound(run, m) <= budget)) continue;
      if (!best || run.cost < best->cost ||
          (run.cost == best->cost && error_bound(run, m) < error_bound(*best, m)))
        best = &run;
    }
    return best;
  }
  /// Runs that no other run beats in both cost and error, cheapest first. Errors below the uncertainty of the
  /// reference are all alike, so at most one of them is in it.
  std::vector<const StudyRun*> front(int m, Stepping stepping = Stepping::any) const {
    std::vector<const StudyRun*> front;
    for (const StudyRun& run : runs)
      if (run.is_usable() && is_of(run, stepping) && std::isfinite(run.errors[std::size_t(m)])) front.push_back(&run);
    const auto error = [&](const StudyRun* run) {
      return std::max(run->errors[std::size_t(m)], measures[std::size_t(m)].uncertainty);
    };
    std::stable_sort(front.begin(), front.end(), [&](const StudyRun* a, const StudyRun* b) {
      return a->cost < b->cost || (a->cost == b->cost && error(a) < error(b));
    });
    std::size_t kept = 0;
    for (std::size_t k = 0; k < front.size(); ++k)
      if (kept == 0 || error(front[k]) < error(front[kept - 1])) front[kept++] = front[k];
    front.resize(kept);
    return front;
  }

  /// Whether a run is one of these.
  static bool is_of(const StudyRun& run, Stepping stepping) {
    return stepping == Stepping::any || run.is_controlled() == (stepping == Stepping::controlled);
  }

  /// `auto loop = scene(ImplicitMidpoint{}, GaussSeidel{.tolerance = 1e-08});  // then loop.step(0.005)`
  std::string line(const StudyRun& run) const {
    return "auto loop = " + call(run) + ";  // then loop.step(" + inner::step_text(run.h) + ")";
  }
  /// `scene(ImplicitMidpoint{}, GaussSeidel{.tolerance = 1e-08})`.
  std::string call(const StudyRun& run) const { return plan.call + "(" + run.code + ")"; }
};

}  // namespace delassus
