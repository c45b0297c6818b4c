/// Steps an engine in the place of a row's loops, keeps the marks that count, and writes each rung down when
/// it ends.
#pragma once

#include "../rows.hpp"
#include "comparison.hpp"

#include <cstdio>
#include <string>
#include <string_view>
#include <vector>

namespace ladders::peers {

/// Why a row is not compared; null where it is.
const char* why_not(const Row& row);

/// One rung as an engine did it. `said` says what stopped it; `is_refused` that nothing was stepped, or
/// that no mark is of poses and velocities.
struct Outcome {
  std::string difficulty, said;
  Level level = Level::failed;
  bool is_refused = false;
  double microseconds = 0;  ///< of the processor, the median step
  struct Figure {
    std::string what;
    double value, silver, gold;
    Level level;
  };
  std::vector<Figure> figures;
};

/// A line for the file between the process that runs a row and the one that reads it, and back.
std::string line_of(const Outcome& outcome);
Outcome outcome_of(const std::string& line);

class Referee : public Comparison {
 public:
  /// Without a kind, the loop itself is measured.
  Referee(const EngineKind* kind, double max_seconds, std::FILE* out)
      : kind_(kind), max_seconds_(max_seconds), out_(out) {}

  void begin(const std::string& difficulty) override;
  void judge(Marks& marks) override;
  bool end(const Rung& rung) override;
  std::unique_ptr<Engine> engine(const Scene& scene, double h) override;
  void note(double seconds, const Reading& reading) override;

 private:
  const EngineKind* kind_;
  double max_seconds_;
  std::FILE* out_;
  Reading worst_;
  double spent_ = 0;
  std::vector<double> steps_;
  bool has_marks_ = true;
};

}  // namespace ladders::peers
