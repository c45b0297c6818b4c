/// A machine as a recording, and as rows of a table: its joints, its free roots.
#pragma once

#include "motion.hpp"

#include <delassus/io/recording.hpp>
#include <delassus/model/model.hpp>

#include <cstdio>
#include <string>
#include <vector>

namespace delassus_run {

/// Pictures of a run: one body a shape of the model, in its order.
class Show {
 public:
  Recording recording;

  Show(const Model& model, const Motion& motion, const Pose& pose, bool has_floor, double frames_per_second);

  /// A sample of the series, and a picture where one is due: true then.
  bool take(const Motion& motion, const StepReport& report, double energy);

 private:
  struct Drawn {
    Index link;  ///< −1: the world
    Pose pose;   ///< of the shape in the link
  };
  RecordedFrame frame(const Motion& motion) const;

  Pose pose_;  ///< of the model's frame in the world
  std::vector<Drawn> drawn_;
};

/// Rows of numbers as CSV, written as they come.
class Rows {
 public:
  /// Opens the file and writes the names of the columns; refuses where it cannot.
  Rows(std::string path, const Model& model, const Motion& motion);
  Rows(const Rows&) = delete;
  Rows& operator=(const Rows&) = delete;
  ~Rows();

  void take(const Motion& motion, const StepReport& report, double kinetic);
  /// Refuses where not all was written.
  void close();

 private:
  void column(const std::string& name);
  void number(double value, int digits);

  std::string path_, line_;
  std::FILE* file_ = nullptr;
  std::vector<Index> joints_;  ///< hinges and slides that move
  std::vector<char> is_turn_;
  std::vector<double> last_;     ///< of `joints_`, rad or m, all turns counted
  std::vector<Index> roots_;   ///< links with six freedoms
};

}  // namespace delassus_run
