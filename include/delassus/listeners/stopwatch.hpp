/// How long each stage takes.
#pragma once

#include <delassus/core/clock.hpp>
#include <delassus/core/expect.hpp>
#include <delassus/core/roles.hpp>
#include <delassus/step/stage.hpp>

#include <array>
#include <cstdio>
#include <string>
#include <vector>

namespace delassus {

/// Wall-clock time of every stage of every step, from one reading of the clock between two stages. Stages that do
/// nothing in a loop show zero. `keep` bounds the memory: later steps are summed but not kept.
template <class Real>
class BasicStopwatch {
 public:
  using plays = role::Listener;
  using listens = ListensToAll;
  /// Of the stages that are timed, in their order.
  static constexpr std::array names{"detect", "linearize", "free motion", "islands", "bias",
                                    "build",  "solve",     "correct",     "advance"};
  static constexpr std::size_t stages = names.size();

  /// Milliseconds of each stage of one step, in the order of `names`.
  using Times = std::array<Real, stages>;

  /// Keeps the times of so many steps at most.
  explicit BasicStopwatch(std::size_t keep = 100000) : keep_(keep) { laps_.reserve(keep < 1024 ? keep : 1024); }

  /// One entry a step, of the first `keep` steps.
  const std::vector<Times>& laps() const { return laps_; }
  /// Of the newest step.
  const Times& last() const { return now_; }

  /// ms, mean over all steps so far.
  Times mean() const {
    Times mean = sum_;
    for (Real& m : mean) m /= Real(steps_ > 1 ? steps_ : 1);
    return mean;
  }

  /// "stage  mean  share" lines.
  void print(std::FILE* out = stdout) const {
    const Times m = mean();
    Real total = 0;
    for (const Real x : m) total += x;
    std::fprintf(out, "%-12s %10s %7s\n", "stage", "ms/step", "share");
    for (std::size_t s = 0; s < stages; ++s)
      std::fprintf(out, "%-12s %10.5f %6.1f%%\n", names[s], m[s], total > 0 ? 100 * m[s] / total : 0);
    std::fprintf(out, "%-12s %10.5f\n", "together", total);
  }

  /// Chrome's trace event format: open the file in a trace viewer. Throws InvalidArgument when it cannot be written.
  void write_trace(const std::string& path) const {
    std::FILE* const file = std::fopen(path.c_str(), "w");
    DELASSUS_EXPECT(file != nullptr, "trace: cannot write '" + path + "'; is its folder there?");
    std::fprintf(file, "[\n");
    Real start = 0;
    for (std::size_t k = 0; k < laps_.size(); ++k)
      for (std::size_t s = 0; s < stages; ++s) {
        std::fprintf(file, "%s{\"name\":\"%s\",\"ph\":\"X\",\"pid\":1,\"tid\":1,\"ts\":%.3f,\"dur\":%.3f,\"args\":{\"step\":%zu}}",
                     k + s == 0 ? "" : ",\n", names[s], start * 1e3, laps_[k][s] * 1e3, k);
        start += laps_[k][s];
      }
    std::fprintf(file, "\n]\n");
    std::fclose(file);
  }

  void after(stage::Begin, const auto&) {
    now_ = {};
    mark_ = SteadyClock().now();
  }
  void after(stage::Detect, const auto&) { lap(0); }
  void after(stage::Linearize, const auto&) { lap(1); }
  void after(stage::FreeMotion, const auto&) { lap(2); }
  void after(stage::Islands, const auto&) { lap(3); }
  void after(stage::Bias, const auto&) { lap(4); }
  void after(stage::Build, const auto&) { lap(5); }
  void after(stage::Solve, const auto&) { lap(6); }
  void after(stage::Correct, const auto&) { lap(7); }
  void after(stage::Advance, const auto&) { lap(8); }
  void after(stage::Step, const auto&) {
    for (std::size_t s = 0; s < stages; ++s) sum_[s] += now_[s];
    ++steps_;
    if (laps_.size() < keep_) laps_.push_back(now_);
  }

 private:
  void lap(std::size_t s) {
    const double t = SteadyClock().now();
    now_[s] += 1e3 * (t - mark_);
    mark_ = t;
  }

  std::size_t keep_;
  double mark_ = 0;  ///< s
  Times now_{}, sum_{};
  std::vector<Times> laps_;
  long steps_ = 0;
};

/// Counts in doubles.
using Stopwatch = BasicStopwatch<double>;

}  // namespace delassus
