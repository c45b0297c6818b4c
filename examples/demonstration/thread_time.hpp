/// How long the processor works between two stages, whatever else the machine does meanwhile.
#pragma once

#include <delassus/core/roles.hpp>
#include <delassus/step/stage.hpp>

#include <ctime>
#include <vector>

namespace demonstration {

/// Milliseconds of this thread's processor time (POSIX) from `From` to `To`, one entry per step. Reading this clock
/// takes a few hundred nanoseconds, so a loop lists it where these do not matter, and once.
template <class From, class To>
class ThreadTime {
 public:
  using plays = delassus::role::Listener;
  using listens = delassus::Listens<From, To>;

  const std::vector<double>& milliseconds() const { return milliseconds_; }

  void after(From, const auto&) { start_ = now(); }
  void after(To, const auto&) { milliseconds_.push_back(now() - start_); }

 private:
  static double now() {
    std::timespec t{};
    clock_gettime(CLOCK_THREAD_CPUTIME_ID, &t);
    return 1e3 * double(t.tv_sec) + 1e-6 * double(t.tv_nsec);
  }

  double start_ = 0;
  std::vector<double> milliseconds_;
};

using StepTime = ThreadTime<delassus::stage::Begin, delassus::stage::Advance>;
using SolveTime = ThreadTime<delassus::stage::Build, delassus::stage::Solve>;

}  // namespace demonstration
