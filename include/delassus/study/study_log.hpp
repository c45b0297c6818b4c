/// The file that keeps a study's finished runs, so that an interrupted one goes on and shards come together.
#pragma once

#include <delassus/study/inner/run_log.hpp>
#include <delassus/study/study.hpp>

#include <algorithm>
#include <limits>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

namespace delassus {

/// One line a run, fields separated by tabs, every digit kept. Lines of other plans, other policies or a
/// write that was cut short are passed over. Files of shards may be joined end to end.
class StudyLog {
 public:
  /// Reads what `path` holds of this study; an empty path keeps nothing.
  StudyLog(std::string path, const Study& study) : log_(std::move(path), "the study's log"), key_(key_of(study)) {
    log_.each_line([&](std::span<const std::string_view> fields) { read(fields, study.measures.size(), std::size_t(study.plan.outputs)); });
  }

  /// A finished run by its number and its policies; null where there is none.
  const StudyRun* find(int number, std::string_view code) const {
    for (const StudyRun& run : runs_)
      if (run.number == number && run.code == code) return &run;
    return nullptr;
  }
  /// The uncertainties of the references by measure and output, if they were found out before.
  const std::optional<std::vector<double>>& uncertainties() const { return uncertainties_; }

  /// Appends a line and closes the file. Throws InvalidArgument when it cannot be written.
  void keep(const StudyRun& run) {
    std::string line = key_ + "\trun\t" + std::to_string(run.number) + "\t" +
                       std::to_string(run.combination) + "\t" + run.code;
    for (const double x : {run.tolerance, run.h, double(run.outcome), run.cost, run.least_cost, run.sweeps,
                           double(run.steps), double(run.capped_steps), run.accuracy, double(run.inner_steps),
                           double(run.repeated)})
      line += "\t" + inner::number_text(x, 17);
    append(line, run.errors);
  }
  /// The same of the references, by measure and within it by output.
  void keep_uncertainties(const std::vector<double>& uncertainties) {
    append(key_ + "\treference", uncertainties);
  }

  /// A number for all that must agree before two runs can stand in one table.
  static std::string key_of(const Study& study) {
    const StudyPlan& plan = study.plan;
    std::string text =
        plan.name + "|" + inner::number_text(plan.duration, 17) + "|" + std::to_string(plan.outputs);
    for (const double h : plan.steps) text += "|h" + inner::number_text(h, 17);
    for (const double a : plan.accuracies) text += "|a" + inner::number_text(a, 17);
    for (const double t : plan.tolerances) text += "|t" + inner::number_text(t, 17);
    for (const StudyMeasure& m : study.measures) text += "|" + m.name + "," + m.unit;
    for (const auto& axis : study.axes)
      for (const std::string& choice : axis) text += "|" + choice;
    return inner::key_of_text(text);
  }

 private:
  void append(std::string line, const std::vector<double>& values) {
    for (const double x : values) line += "\t" + inner::number_text(x, 17);
    log_.append(std::move(line));
  }

  void read(std::span<const std::string_view> fields, std::size_t measures, std::size_t outputs) {
    if (fields.size() < 2 || fields[0] != key_) return;
    const bool is_reference = fields[1] == "reference", is_run = fields[1] == "run";
    const std::size_t first = is_reference ? 2 : 5, count_of_all = is_reference ? 2 + measures * outputs : 16 + measures;
    if (!(is_reference || is_run) || fields.size() != count_of_all) return;
    std::vector<double> numbers;
    for (const std::string_view field : fields.subspan(first)) {
      const std::optional<double> value = inner::number_in(field);
      if (!value) return;
      numbers.push_back(*value);
    }
    if (is_reference) uncertainties_ = std::move(numbers);
    else read_run(fields, numbers);
  }

  /// `numbers` are those from the fifth field on.
  void read_run(std::span<const std::string_view> fields, const std::vector<double>& numbers) {
    const auto number = [&](std::size_t k) { return numbers[k - 5]; };
    const auto count = [&](std::size_t k, double most) { return inner::count_in(fields[k], most); };
    const long outcome = count(7, double(Outcome::too_slow));
    constexpr double most_runs = std::numeric_limits<int>::max(), most_steps = 9007199254740992.0;  // 2⁵³
    StudyRun run{.number = int(count(2, most_runs)),
                 .combination = int(count(3, most_runs)),
                 .code = std::string(fields[4]),
                 .tolerance = number(5),
                 .h = number(6),
                 .accuracy = number(13),
                 .outcome = Outcome(outcome),
                 .cost = number(8),
                 .least_cost = number(9),
                 .sweeps = number(10),
                 .steps = count(11, most_steps),
                 .inner_steps = count(14, most_steps),
                 .repeated = count(15, most_steps),
                 .capped_steps = count(12, most_steps),
                 .errors = {}};
    if (std::min({long(run.number), long(run.combination), outcome, run.steps, run.inner_steps, run.repeated, run.capped_steps}) < 0)
      return;
    run.errors.assign(numbers.begin() + 11, numbers.end());
    runs_.push_back(std::move(run));
  }

  inner::RunLog log_;
  std::string key_;
  std::vector<StudyRun> runs_;
  std::optional<std::vector<double>> uncertainties_;
};

}  // namespace delassus
