/// How long the processor works on a step, and on its solve, whatever else the machine does meanwhile.
#pragma once

#include <delassus/core/roles.hpp>
#include <delassus/loop/stage.hpp>

#include <ctime>
#include <vector>

namespace demonstration {

/// Milliseconds of this thread's processor time (POSIX), one entry per step; listeners are not counted.
class ThreadTime {
 public:
  using plays = delassus::role::Listener;
  using listens = delassus::Listens<delassus::stage::Begin, delassus::stage::Build, delassus::stage::Solve,
                                    delassus::stage::Advance>;

  const std::vector<double>& steps() const { return steps_; }
  const std::vector<double>& solves() const { return solves_; }

  void after(delassus::stage::Begin, const auto&) { begin_ = now(); }
  void after(delassus::stage::Build, const auto&) { built_ = now(); }
  void after(delassus::stage::Solve, const auto&) { solves_.push_back(now() - built_); }
  void after(delassus::stage::Advance, const auto&) { steps_.push_back(now() - begin_); }

 private:
  static double now() {
    std::timespec t{};
    clock_gettime(CLOCK_THREAD_CPUTIME_ID, &t);
    return 1e3 * double(t.tv_sec) + 1e-6 * double(t.tv_nsec);
  }

  double begin_ = 0, built_ = 0;
  std::vector<double> steps_, solves_;
};

}  // namespace demonstration
