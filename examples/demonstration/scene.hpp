/// The scenes of the demonstration, and what each hands back: a recording, its numbers, and the bounds it broke.
#pragma once

#include <delassus/core/index.hpp>
#include <delassus/io/recording.hpp>
#include <delassus/io/table.hpp>

#include <array>
#include <functional>
#include <string>
#include <vector>

namespace demonstration {

using namespace delassus;

/// Hears how much of a scene is done, 0 … 1.
using Watch = std::function<void(double)>;

struct Scene {
  std::string backend;  ///< of collision detection
  double h = 0;         ///< s
  int steps = 0;
  Index bodies = 0;  ///< that move
  double mean_contacts = 0;
  double max_penetration = 0;     ///< m
  double max_joint_gap = 0;       ///< m
  double milliseconds = 0;        ///< of processor time, a step
  double kinetic_energy = 0;      ///< at the end, J
  std::array<int, 5> status{};    ///< steps by delassus::Status
  Recording recording;
  std::vector<std::string> broken;  ///< a sentence for each bound of physics that does not hold

  /// Notes that `value` must stay below `bound`.
  void expect_below(double value, double bound, const std::string& what, const std::string& unit);
  /// The energy (J) may end lower than it began; `rise` is the most it ever stood above an earlier moment.
  double energy_lost() const;
  double energy_rise() const;
};

double mean_of(const std::vector<double>& values);
/// The value below which `share` of the values lie.
double quantile_of(std::vector<double> values, double share);

/// Each runs for its full time, or a short one when `is_quick`.
Scene falling_box(bool is_quick, const Watch& watch);
Scene stack(bool is_quick, const Watch& watch);
Scene slope(bool is_quick, const Watch& watch);
Scene chain(bool is_quick, const Watch& watch);
Scene wall(bool is_quick, const Watch& watch);
Scene pile(bool is_quick, const Watch& watch);
Scene soft_grip(bool is_quick, const Watch& watch);
Scene soft_beam(bool is_quick, const Watch& watch);
Scene needle(bool is_quick, const Watch& watch);

/// One row per scene, in the order given.
Table table_of_scenes(const std::vector<Scene>& scenes);
/// What accuracy costs: the stack of ten boxes at four tolerances.
Table table_of_accuracy(bool is_quick, const Watch& watch);

}  // namespace demonstration
