/// A ladder: one hard case made harder rung by rung, with the figures of every rung and the level they reach.
#pragma once

#include "peers/comparison.hpp"

#include <delassus/io/progress.hpp>

#include <cmath>
#include <ctime>
#include <exception>
#include <limits>
#include <string>
#include <utility>
#include <vector>

namespace ladders {

/// What a rung reached: bronze fails safely, silver is what good engines do, gold meets the stated number.
enum class Level { failed, bronze, silver, gold };

constexpr const char* name(Level level) {
  constexpr const char* names[] = {"failed", "bronze", "silver", "gold"};
  return names[int(level)];
}

inline constexpr double unbounded = std::numeric_limits<double>::infinity();

/// One figure of a rung, and the largest value that each level allows.
struct Mark {
  const char* what;
  double value;
  double silver, gold;
  double bronze = std::numeric_limits<double>::max();  ///< finite is the least

  /// What is not finite has failed.
  Level level() const {
    if (!(value <= bronze)) return Level::failed;
    return value <= gold ? Level::gold : value <= silver ? Level::silver : Level::bronze;
  }
};

using Marks = std::vector<Mark>;

struct Rung {
  std::string difficulty;
  Marks marks;
  Level level = Level::failed;
  std::string trouble;  ///< why there are no marks
  double seconds = 0;
};

/// The mark that keeps a rung from gold, the worst first; null where none does.
inline const Mark* worst(const Rung& rung) {
  const Mark* out = nullptr;
  for (const Mark& mark : rung.marks)
    if (mark.level() < Level::gold && (!out || mark.level() < out->level())) out = &mark;
  return out;
}

/// Thrown out of a rung that takes longer than it may.
struct OutOfTime : std::exception {
  const char* what() const noexcept override { return "out of time"; }
};

/// Runs the rungs of one row. A rung that throws or takes too long has failed; the others are run all the
/// same, but after one that took too long none. Seconds are of the processor: what else the machine does is
/// no property of a rung.
class Ladder {
 public:
  Ladder(std::string label, bool is_quick, double max_seconds, peers::Comparison* comparison = nullptr)
      : progress_(std::move(label)), is_quick_(is_quick), max_seconds_(max_seconds), comparison_(comparison) {}

  /// f() returns the marks of a rung. Quick, only the first rung is run.
  template <class F>
  void rung(const std::string& difficulty, F&& f) {
    if (is_over_ || (is_quick_ && !rungs_.empty())) return;
    Rung rung{.difficulty = difficulty};
    if (comparison_) comparison_->begin(difficulty);
    start_ = std::clock();
    try {
      rung.marks = f();
      if (comparison_) comparison_->judge(rung.marks);
      rung.level = Level::gold;
      for (const Mark& mark : rung.marks) rung.level = std::min(rung.level, mark.level());
    } catch (const OutOfTime&) {
      is_over_ = true;
      rung.trouble = "not done in " + std::to_string(int(max_seconds_)) + " s of the processor";
    } catch (const std::exception& error) {
      rung.trouble = error.what();
    }
    rung.seconds = seconds();
    rungs_.push_back(rung);
    if (comparison_ && !comparison_->end(rung)) is_over_ = true;
  }

  /// To be called now and then within a rung; `fraction` of it is done.
  void show(double fraction) {
    progress_.show(fraction);
    if (seconds() > max_seconds_) throw OutOfTime();
  }

  const std::vector<Rung>& rungs() const { return rungs_; }
  bool is_quick() const { return is_quick_; }
  /// Null but where rungs are compared with other engines.
  peers::Comparison* comparison() const { return comparison_; }

 private:
  double seconds() const { return double(std::clock() - start_) / CLOCKS_PER_SEC; }

  delassus::Progress progress_;
  bool is_quick_, is_over_ = false;
  double max_seconds_;
  peers::Comparison* comparison_;
  std::clock_t start_ = std::clock();
  std::vector<Rung> rungs_;
};

}  // namespace ladders
