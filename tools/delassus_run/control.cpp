// Reads a table of controls.
#include "control.hpp"

#include <delassus/io/inner/text_reader.hpp>
#include <delassus/model/actuators.hpp>

#include <charconv>
#include <string_view>

namespace delassus_run {

using namespace delassus;

namespace {

/// The fields of a line, without quotes and the spaces around them.
std::vector<std::string_view> fields_of(std::string_view line) {
  std::vector<std::string_view> fields;
  for (std::size_t at = 0; at <= line.size();) {
    const std::size_t end = std::min(line.find(',', at), line.size());
    std::string_view field = line.substr(at, end - at);
    while (!field.empty() && std::string_view(" \t\r\"").find(field.front()) != field.npos) field.remove_prefix(1);
    while (!field.empty() && std::string_view(" \t\r\"").find(field.back()) != field.npos) field.remove_suffix(1);
    fields.push_back(field);
    at = end + 1;
  }
  return fields;
}

bool is_time(std::string_view name) { return name == "time" || name == "time (s)"; }

}  // namespace

ControlTable::ControlTable(const std::string& path, const Machine& machine) {
  const std::string text = inner::read_text(path);
  std::size_t columns = 0;
  int line = 0;
  for (std::size_t at = 0; at < text.size();) {
    const std::size_t end = std::min(text.find('\n', at), text.size());
    const std::vector<std::string_view> fields = fields_of(std::string_view(text).substr(at, end - at));
    at = end + 1, ++line;
    const std::string here = path + ":" + std::to_string(line) + ": ";
    if (fields.size() == 1 && fields[0].empty()) continue;
    if (columns == 0) {
      DELASSUS_EXPECT(is_time(fields[0]), here + "the first column is '" + std::string(fields[0]) + "' and must be 'time', s");
      for (std::size_t k = 1; k < fields.size(); ++k) {
        try {
          actuators_.push_back(actuator_of(machine, fields[k]));
        } catch (const InvalidArgument& error) {
          inner::refuse(here + error.what());
        }
      }
      columns = fields.size();
      continue;
    }
    DELASSUS_EXPECT(fields.size() == columns, here + std::to_string(fields.size()) + " fields, where the first line has " + std::to_string(columns));
    for (std::size_t k = 0; k < columns; ++k) {
      double value = 0;
      const auto [last, error] = std::from_chars(fields[k].data(), fields[k].data() + fields[k].size(), value);
      DELASSUS_EXPECT(error == std::errc{} && last == fields[k].data() + fields[k].size() && std::isfinite(value),
                      here + "'" + std::string(fields[k].substr(0, 40)) + "' is no finite number");
      if (k > 0) values_.push_back(value);
      else {
        DELASSUS_EXPECT(times_.empty() || value > times_.back(), here + "time " + inner::text(value) + " s does not come after " + (times_.empty() ? "" : inner::text(times_.back())) + " s");
        times_.push_back(value);
      }
    }
  }
  DELASSUS_EXPECT(!times_.empty(), path + ": no row of controls; write a line 'time,NAME...' and rows of numbers below it");
  find_clamped(path, machine);
}

/// One sentence an actuator, with the first number of its column that is beyond.
void ControlTable::find_clamped(const std::string& path, const Machine& machine) {
  for (std::size_t k = 0; k < actuators_.size(); ++k) {
    const model::Actuator& actuator = machine.actuators[std::size_t(actuators_[k])].actuator;
    if (!actuator.control_is_limited) continue;
    for (std::size_t row = 0; row < times_.size(); ++row) {
      const double value = values_[row * actuators_.size() + k];
      if (value >= actuator.control_lower && value <= actuator.control_upper) continue;
      notes.push_back(path + ": " + inner::text(value) + " for '" + actuator.name + "' at " + inner::text(times_[row]) + " s is beyond its range, " + inner::text(actuator.control_lower) +
                      " to " + inner::text(actuator.control_upper) + ", and counts as its end");
      break;
    }
  }
}

void ControlTable::set(Machine& machine, double time) {
  while (next_ < times_.size() && times_[next_] <= time + 1e-12 * (1 + time)) {
    for (std::size_t k = 0; k < actuators_.size(); ++k)
      machine.controls[std::size_t(actuators_[k])] = values_[next_ * actuators_.size() + k];
    ++next_;
  }
}

}  // namespace delassus_run
