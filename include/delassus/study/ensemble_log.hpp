/// The file that keeps the finished runs of an ensemble, so that an interrupted one goes on and shards come together.
#pragma once

#include <delassus/core/expect.hpp>
#include <delassus/io/inner/text.hpp>
#include <delassus/study/ensemble_results.hpp>
#include <delassus/study/inner/run_log.hpp>

#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

namespace delassus {

/// One line a run, fields separated by tabs, every digit kept: the key of the ensemble, `ensemble`, the run's number and parameters,
/// steps, steps not converged, failure, the values row after row, the hash. The hash has sixteen digits, so that a line cut short is known.
/// Files of shards may be joined end to end, in any order.
class EnsembleLog {
 public:
  /// Reads what plan.log holds of this ensemble of so many runs; an empty path keeps nothing. Throws InvalidArgument when it holds
  /// runs of another one, or cannot be written.
  EnsembleLog(const EnsemblePlan& plan, std::size_t count)
      : plan_(plan), key_(key_of(plan, count)), log_(plan.log, "the ensemble's log"), known_(log_.is_kept() ? count : 0) {
    log_.each_line([&](std::span<const std::string_view> fields) { read(fields); });
    std::string comment = plan.name + ": " + std::to_string(count) + " runs of " + std::to_string(plan.steps) + " steps of " +
                          inner::number_text(plan.h, 17) + " s; key, ensemble, run, parameters, steps, steps not converged, failure";
    for (const std::string& name : plan.observations) comment += ", " + name;
    log_.begin(inner::field_text(comment) + (plan.every > 0 ? " of each row" : "") + ", hash");
  }

  bool is_kept() const { return log_.is_kept(); }  ///< in a file

  /// A finished run by its number and its parameters; null where there is none.
  const EnsembleRun* find(long number, std::string_view parameters) const {
    if (std::size_t(number) >= known_.size()) return nullptr;
    const EnsembleRun& run = known_[std::size_t(number)];
    return run.number == number && run.parameters == parameters ? &run : nullptr;
  }

  /// Appends a line and closes the file. Throws InvalidArgument when it cannot be written.
  void keep(const EnsembleRun& run) {
    if (!is_kept()) return;
    std::string line = key_ + "\tensemble\t" + std::to_string(run.number) + "\t" + run.parameters + "\t" + std::to_string(run.steps) + "\t" +
                       std::to_string(run.capped_steps) + "\t" + run.failure;
    for (const double x : run.values) line += "\t" + inner::number_text(x, 17);
    log_.append(line + "\t" + inner::hex_text(run.hash));
  }

  /// A number for all that must agree before two runs can stand in one table, but for their parameters.
  static std::string key_of(const EnsemblePlan& plan, std::size_t count) {
    std::string text = plan.name + "|" + std::to_string(count) + "|" + std::to_string(plan.steps) + "|" + inner::number_text(plan.h, 17) +
                       "|" + std::to_string(plan.every);
    for (const std::string& name : plan.observations) text += "|" + name;
    return inner::key_of_text(text);
  }

 private:
  static constexpr std::size_t first_value = 7;

  void read(std::span<const std::string_view> fields) {
    if (fields.size() <= first_value || fields[1] != "ensemble" || !inner::hex_in(fields[0])) return;
    DELASSUS_EXPECT(fields[0] == key_, "ensemble '" + plan_.name + "': its log '" + plan_.log +
                                           "' has runs of another ensemble: another name, number of runs, step, number of steps, or other "
                                           "observations; name another file");
    const std::optional<std::uint64_t> hash = inner::hex_in(fields.back());
    const std::span<const std::string_view> values = fields.subspan(first_value, fields.size() - first_value - 1);
    const std::size_t width = plan_.observations.size();
    EnsembleRun run{.number = inner::count_in(fields[2], double(known_.size()) - 1),
                    .parameters = std::string(fields[3]),
                    .failure = std::string(fields[6]),
                    .steps = inner::count_in(fields[4], double(plan_.steps)),
                    .capped_steps = inner::count_in(fields[5], double(plan_.steps)),
                    .hash = hash.value_or(0),
                    .width = width,
                    .values = {}};
    if (!hash || run.number < 0 || run.steps < 0 || run.capped_steps < 0) return;
    if (run.is_sound() ? values.size() != plan_.rows() * width : values.size() % width != 0) return;
    for (const std::string_view field : values) {
      const std::optional<double> value = inner::number_in(field);
      if (!value) return;
      run.values.push_back(*value);
    }
    known_[std::size_t(run.number)] = std::move(run);
  }

  EnsemblePlan plan_;
  std::string key_;
  inner::RunLog log_;
  std::vector<EnsembleRun> known_;  ///< by number; −1 where none is known
};

}  // namespace delassus
