/// What the built-in scenes of delassus_study share: options, and the way from a scene to its files.
#pragma once

#include "program_threads.hpp"

#include <delassus/adapters/posix.hpp>
#include <delassus/io/csv.hpp>
#include <delassus/study/diagram.hpp>
#include <delassus/study/sweep.hpp>
#include <delassus/study/tables.hpp>

#include <algorithm>
#include <cstddef>
#include <cstdio>
#include <filesystem>
#include <string>

namespace study_program {

using namespace delassus;

struct Options {
  std::string out = "out/study", scene, unknown;
  double budget = 0;  ///< in the unit of the scene's first measure; 0: the scene's own
  int shard = 0, shards = 1;
  int threads = 1;    ///< runs at once; 0: one a processor
  bool has_accuracy = false, is_quick = false, is_quiet = false, wants_help = false;
};

/// Announces the study, runs it, writes <out>/<file>.svg and .csv, prints the best and what failed, and
/// measures the chosen run again, alone. False when that run does not hold the budget, or a cheaper one does.
template <class Scene, class List, class M, class R = References<>>
bool run_study(const Options& options, const char* file, double usual_budget, const Scene& scene,
               const List& list, StudyPlan plan, const M& measures, const R& references = {}) {
  const double budget = options.budget > 0 ? options.budget : usual_budget;
  plan.is_quiet = options.is_quiet;
  plan.shard = options.shard;
  plan.shards = options.shards;
  plan.max_seconds = 20;
  if (options.is_quick) plan.repeats = 1, plan.steps.resize(2), plan.tolerances.resize(1), plan.accuracies.resize(std::min<std::size_t>(plan.accuracies.size(), 2));
  const std::string base = (std::filesystem::path(options.out) / file).string();
  plan.log = base +
             (plan.shards > 1 ? "." + std::to_string(plan.shard) + "of" + std::to_string(plan.shards) : "") +
             ".log";
  if (!options.is_quiet) std::printf("\n%s.\n", announcement(list, plan).c_str());
  std::fflush(stdout);

  const Study study = sweep(scene, list, plan, measures, references, ThreadClock{}, program_threads(options.threads));
  write_diagram(base + ".svg", study, {.measure = 0, .budget = budget});
  write_csv(base + ".csv", runs_table(study));
  if (!options.is_quiet) {
    print(front_table(study));
    if (const Table trouble = trouble_table(study); !trouble.rows.empty()) std::puts(""), print(trouble);
  }
  std::printf(
      "manifest: %s, key %s, commit %s, %s, %s, %zu runs of %d, %d from the log; no random number is drawn\n",
      file, StudyLog::key_of(study).c_str(), DELASSUS_STUDY_COMMIT, DELASSUS_STUDY_COMPILER,
      DELASSUS_STUDY_FLAGS, study.runs.size(), study.run_count(), study.resumed);

  const StudyRun* best = study.cheapest(0, budget);
  if (!best) {
    std::printf("%s: no run is known to hold %s\n", file,
                inner::with_prefix(budget, study.measures[0].unit).c_str());
    return true;
  }
  StudyPlan again = plan;
  again.only = best->number;
  again.log.clear();
  const Study alone = sweep(scene, list, again, measures, references, ThreadClock{});
  const double bound = alone.error_bound(alone.runs[0], 0);
  std::printf("%s, cheapest within %s (measured again: %s):\n  %s\n", file,
              inner::with_prefix(budget, study.measures[0].unit).c_str(),
              inner::with_prefix(bound, study.measures[0].unit).c_str(), study.line(*best).c_str());
  int cheaper = 0;
  for (const StudyRun& run : study.runs)
    cheaper += run.is_usable() && run.cost < best->cost && study.error_bound(run, 0) <= budget;
  if (cheaper > 0) std::printf("%s: %d cheaper runs hold it too\n", file, cheaper);
  return bound <= budget && cheaper == 0;
}

bool sliding_box(const Options& options);
bool double_pendulum(const Options& options);
bool ten_boxes(const Options& options);
bool heavy_chain(const Options& options);
bool soft_bar(const Options& options);
/// Fixed steps and steps that keep an accuracy, of the same parts.
bool double_pendulum_accuracy(const Options& options);
/// The same.
bool bouncing_ball_accuracy(const Options& options);

}  // namespace study_program
