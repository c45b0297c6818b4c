/// One line on the terminal that says how far a long run is and how long it will still take.
#pragma once

#include <algorithm>
#include <chrono>
#include <cstdio>
#include <filesystem>
#include <string>
#include <system_error>
#include <utility>

namespace delassus {

/// Rewrites one line of stderr ten times a second, and only where stderr is a terminal. Gone when destroyed.
class Progress {
 public:
  /// `label` stands before the bar.
  explicit Progress(std::string label) : label_(std::move(label)) {
    std::error_code missing;
    is_shown_ = std::filesystem::is_character_file("/dev/stderr", missing);
  }
  Progress(const Progress&) = delete;
  Progress& operator=(const Progress&) = delete;
  ~Progress() {
    if (is_shown_ && shown_ != start_) std::fputs("\r\033[K", stderr);
  }

  /// `fraction` of the work is done, 0 … 1.
  void show(double fraction) {
    const Clock::time_point now = Clock::now();
    if (!is_shown_ || now - shown_ < std::chrono::milliseconds(100)) return;
    shown_ = now;
    const double left = seconds(now - start_) * (1 / std::max(fraction, 1e-9) - 1);
    const int filled = int(24 * fraction + 0.5);
    std::fprintf(stderr, "\r\033[K%s  [%s%s] %3.0f %%", label_.c_str(), std::string(filled, '#').c_str(),
                 std::string(24 - filled, '.').c_str(), 100 * fraction);
    if (fraction > 0.01) std::fprintf(stderr, "  %.0f s left", left);
    std::fflush(stderr);
  }

  /// s of wall-clock time since it was made.
  double elapsed() const { return seconds(Clock::now() - start_); }

 private:
  using Clock = std::chrono::steady_clock;
  static double seconds(Clock::duration d) { return std::chrono::duration<double>(d).count(); }

  std::string label_;
  bool is_shown_ = false;
  Clock::time_point start_ = Clock::now(), shown_ = start_;
};

}  // namespace delassus
