/// The time of steps, against the median of those that had as much to do.
#pragma once

#include <array>
#include <bit>
#include <ctime>

namespace fuzz {

/// CPU time of this thread, s.
inline double thread_seconds() {
  std::timespec now{};
  clock_gettime(CLOCK_THREAD_CPUTIME_ID, &now);
  return double(now.tv_sec) + 1e-9 * double(now.tv_nsec);
}

/// A median for every power of two of a size. An estimate that goes up 1 % where a time is above it, and down
/// where it is below, ends where as many are above as below: at the median.
class StepTimes {
 public:
  /// How many times the median of its size a step took; 1 for each of the first 1000.
  double share(int size, double seconds) {
    Median& of = medians_[std::bit_width(unsigned(size))];
    if (of.count++ == 0) of.seconds = seconds;
    of.seconds *= seconds > of.seconds ? 1.01 : 1 / 1.01;
    return of.count > 1000 ? seconds / of.seconds : 1;
  }

 private:
  struct Median {
    long count = 0;
    double seconds = 0;
  };
  std::array<Median, 33> medians_{};
};

}  // namespace fuzz
