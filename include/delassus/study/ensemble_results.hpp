/// What the runs of an ensemble are asked, and what they showed.
#pragma once

#include <delassus/core/expect.hpp>

#include <cstddef>
#include <cstdint>
#include <span>
#include <string>
#include <vector>

namespace delassus {

/// The run-time side of an ensemble: what all its runs do, and where they are kept.
struct EnsemblePlan {
  std::string name = "ensemble";  ///< for messages and the log
  long steps = 0;                 ///< of each run
  double h = 0;                   ///< s
  std::vector<std::string> observations{};  ///< what the numbers of a row are, with their units
  long every = 0;                 ///< steps from one row to the next, the first at the start; 0: one row, at the end
  std::string log{};  ///< file that keeps each finished run; an ensemble that was interrupted goes on from it
  /// From 0 to `shards` − 1.
  int shard = 0, shards = 1;  ///< only runs whose number is `shard` modulo `shards`
  bool is_quiet = false;      ///< no progress line

  /// Throws InvalidArgument for a plan that cannot be run.
  void check() const {
    const std::string who = "ensemble '" + name + "': ";
    DELASSUS_EXPECT(steps > 0, who + "steps " + std::to_string(steps) + " must be > 0");
    inner::expect_positive(who + "h", h, "s");
    DELASSUS_EXPECT(!observations.empty(), who + "observations is empty; name at least one number that observe returns");
    DELASSUS_EXPECT(every >= 0 && (every == 0 || steps % every == 0),
                    who + "every " + std::to_string(every) + " must be 0, or divide steps " + std::to_string(steps));
    DELASSUS_EXPECT(shards > 0 && shard >= 0 && shard < shards,
                    who + "shard " + std::to_string(shard) + " must be one of 0 … " + std::to_string(shards - 1));
  }
  /// Whether this run is to be done here.
  bool wants(long run) const { return run % shards == shard; }
  /// s, simulated, at a row of a run.
  double time(std::size_t row) const { return double(every > 0 ? long(row) * every : steps) * h; }
  /// Of a run that comes to its end.
  std::size_t rows() const { return every > 0 ? std::size_t(steps / every) + 1 : 1; }
};

/// One world from its start to its end.
struct EnsembleRun {
  long number = -1;        ///< of its parameters in the list, from 0
  std::string parameters{};  ///< as text; empty where they are neither numbers nor words
  std::string failure{};     ///< why it ended early; empty for a sound run
  long steps = 0;          ///< it took
  long capped_steps = 0;   ///< of them, those that did not converge
  std::uint64_t hash = 0;  ///< `state_hash` at its end; 0 of a run that failed
  std::size_t width = 1;   ///< numbers of a row
  std::vector<double> values{};  ///< row after row; of a failed run those before it failed

  bool is_sound() const { return failure.empty(); }  ///< it came to its end
  std::size_t rows() const { return values.size() / width; }
  /// What was observed, in the order of `EnsemblePlan::observations`.
  std::span<const double> row(std::size_t row) const {
    DELASSUS_EXPECT(row < rows(), "ensemble: run " + std::to_string(number) + " has " + std::to_string(rows()) + " rows, none is number " +
                                      std::to_string(row) + (is_sound() ? "" : "; it failed: " + failure));
    return {values.data() + row * width, width};
  }
  /// The last row that a sound run has. Throws InvalidArgument with the failure of one that has failed.
  std::span<const double> last() const {
    DELASSUS_EXPECT(is_sound(), "ensemble: run " + std::to_string(number) + " has no last row; it failed: " + failure);
    return row(rows() - 1);
  }
};

/// A plan and what its runs showed.
struct EnsembleResults {
  EnsemblePlan plan;              ///< as it was given
  std::vector<EnsembleRun> runs;  ///< of this shard, in the order of their numbers
  long resumed = 0;               ///< of them, read from the log

  /// How many runs failed.
  long failed() const {
    long count = 0;
    for (const EnsembleRun& run : runs) count += !run.is_sound();
    return count;
  }
};

}  // namespace delassus
