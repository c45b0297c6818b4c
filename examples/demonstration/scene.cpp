#include "scene.hpp"

#include <delassus/core/status.hpp>

#include <algorithm>
#include <cmath>
#include <numeric>

namespace demonstration {

double mean_of(const std::vector<double>& values) {
  return values.empty() ? 0 : std::accumulate(values.begin(), values.end(), 0.0) / double(values.size());
}

double quantile_of(std::vector<double> values, double share) {
  if (values.empty()) return 0;
  const auto place = values.begin() + std::ptrdiff_t(share * double(values.size() - 1));
  std::nth_element(values.begin(), place, values.end());
  return *place;
}

void Scene::expect_below(double value, double bound, const std::string& what, const std::string& unit) {
  if (value < bound) return;  // and not a number is not below
  const char* space = unit.empty() ? "" : " ";
  broken.push_back(recording.name + ": " + what + " is " + Cell(value).text + space + unit + ", and must stay below " +
                   Cell(bound).text + space + unit);
}

double Scene::energy_lost() const {
  const std::vector<double>& energy = recording.steps.energy;
  return energy.empty() ? 0 : energy.front() - energy.back();
}

double Scene::energy_rise() const {
  double rise = 0, lowest = recording.steps.energy.empty() ? 0 : recording.steps.energy.front();
  for (const double e : recording.steps.energy) {
    rise = std::max(rise, e - lowest);
    lowest = std::min(lowest, e);
  }
  return rise;
}

namespace {

/// "720 of 720", or "706 of 720: 14 max_iterations".
std::string converged_text(const Scene& scene) {
  std::string text = std::to_string(scene.status[0]) + " of " + std::to_string(scene.steps), rest;
  for (std::size_t s = 1; s < scene.status.size(); ++s)
    if (scene.status[s] > 0)
      rest += (rest.empty() ? ": " : ", ") + std::to_string(scene.status[s]) + " " + name(Status(s));
  return text + rest;
}

/// Three digits, or all in front of the point.
Cell readable(double x) { return std::abs(x) >= 100 ? Cell(std::lround(x)) : Cell(x); }

/// Mean and 95 %.
std::string pair_text(const std::vector<double>& values) {
  return readable(mean_of(values)).text + " / " + readable(quantile_of(values, 0.95)).text;
}

}  // namespace

Table table_of_scenes(const std::vector<Scene>& scenes) {
  Table table{.title = "What each scene did, and what it cost",
              .caption = "Contacts: mean. Sweeps of the solver: mean / 95 % of the steps take no more. Violation: the "
                         "deepest overlap, or the widest joint gap. Rise: the most that kinetic and potential energy "
                         "together ever stood above an earlier moment. Times are of one processor core.",
              .columns = {"scene", "bodies", "collision", "contacts", "sweeps", "residual max", "violation max (mm)",
                          "energy lost (J)", "rise (J)", "step (ms)", "× real time", "steps converged"}};
  for (const Scene& s : scenes) {
    const RecordedSteps& steps = s.recording.steps;
    const double worst = steps.residual.empty() ? 0 : *std::max_element(steps.residual.begin(), steps.residual.end());
    table.add({s.recording.name, s.bodies, s.backend, std::lround(s.mean_contacts), pair_text(steps.sweeps),
               Cell(worst, 2), Cell(1e3 * std::max(s.max_penetration, s.max_joint_gap), 2),
               readable(s.energy_lost()), Cell(s.energy_rise(), 2), Cell(s.milliseconds),
               readable(1e3 * s.h / s.milliseconds), converged_text(s)});
  }
  return table;
}

}  // namespace demonstration
