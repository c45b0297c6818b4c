/// The file that keeps a study's finished runs, so that an interrupted one goes on and shards come together.
#pragma once

#include <delassus/study/study.hpp>

#include <algorithm>
#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <fstream>
#include <limits>
#include <optional>
#include <sstream>
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
  StudyLog(std::string path, const Study& study) : path_(std::move(path)), key_(key_of(study)) {
    std::ifstream file(path_);
    for (std::string line; std::getline(file, line);) {
      ends_midway_ = file.eof();
      if (!ends_midway_) read(line, study.measures.size(), std::size_t(study.plan.outputs));
    }
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
    std::uint64_t hash = 14695981039346656037ull;  // FNV-1a
    for (const char c : text) hash = (hash ^ std::uint8_t(c)) * 1099511628211ull;
    char buffer[20];
    std::snprintf(buffer, sizeof buffer, "%016llx", static_cast<unsigned long long>(hash));
    return buffer;
  }

 private:
  void append(std::string line, const std::vector<double>& values) {
    if (path_.empty()) return;
    if (std::exchange(ends_midway_, false)) line.insert(0, "\n");
    for (const double x : values) line += "\t" + inner::number_text(x, 17);
    std::FILE* file = std::fopen(path_.c_str(), "ab");
    DELASSUS_EXPECT(file != nullptr,
                    "cannot open the study's log '" + path_ + "' for writing; does its folder exist?");
    const bool is_written = std::fputs((line + "\n").c_str(), file) >= 0;
    const bool is_closed = std::fclose(file) == 0;
    DELASSUS_EXPECT(is_written && is_closed,
                    "cannot write all of the study's log '" + path_ + "'; is the disk full?");
  }

  void read(const std::string& line, std::size_t measures, std::size_t outputs) {
    std::vector<std::string> fields;
    std::istringstream stream(line);
    for (std::string field; std::getline(stream, field, '\t');) fields.push_back(field);
    const auto number = [&](std::size_t k) { return std::strtod(fields[k].c_str(), nullptr); };
    // A count that a double holds exactly; −1 for what somebody else wrote there.
    const auto count = [&](std::size_t k, double most) {
      const double value = number(k);
      return value >= 0 && value <= most ? long(value) : -1l;
    };
    if (fields.size() < 2 || fields[0] != key_) return;
    if (fields[1] == "reference" && fields.size() == 2 + measures * outputs) {
      uncertainties_.emplace();
      for (std::size_t k = 2; k < fields.size(); ++k) uncertainties_->push_back(number(k));
    }
    if (fields[1] != "run" || fields.size() != 16 + measures) return;
    const long outcome = count(7, double(Outcome::too_slow));
    constexpr double most_runs = std::numeric_limits<int>::max(), most_steps = 9007199254740992.0;  // 2⁵³
    StudyRun run{.number = int(count(2, most_runs)),
                 .combination = int(count(3, most_runs)),
                 .code = fields[4],
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
    for (std::size_t k = 16; k < fields.size(); ++k) run.errors.push_back(number(k));
    runs_.push_back(std::move(run));
  }

  std::string path_, key_;
  bool ends_midway_ = false;  ///< in a line that a crash cut short
  std::vector<StudyRun> runs_;
  std::optional<std::vector<double>> uncertainties_;
};

}  // namespace delassus
