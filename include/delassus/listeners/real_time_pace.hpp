/// Steps that take as long as they simulate.
#pragma once

#include <delassus/core/clock.hpp>
#include <delassus/core/cmath.hpp>
#include <delassus/core/expect.hpp>
#include <delassus/core/roles.hpp>
#include <delassus/core/sort.hpp>
#include <delassus/step/stage.hpp>

#include <algorithm>
#include <chrono>
#include <concepts>
#include <limits>
#include <thread>
#include <vector>

namespace delassus {

/// A clock that can wait: `sleep_until(t)` returns when `now() >= t`, at once when that is so already.
template <class C>
concept PatientClock = Clock<C> && requires(const C clock, double t) {
  { clock.sleep_until(t) } -> std::same_as<void>;
};

/// The steady clock, which lets the thread sleep. The system wakes it some tens of microseconds late.
struct SleepingClock : SteadyClock {
  /// `t` in s on this clock.
  void sleep_until(double t) const {
    const double left = t - now();
    if (left > 0) std::this_thread::sleep_for(std::chrono::duration<double>(left));
  }
};

/// Step n of length h_n ends no sooner than
///
///   t_n = t_(n−1) + h_n,   t_0 the moment the first step began,
///
/// on the clock: the loop sleeps what is left. The schedule is absolute, so a sleep that was too long costs the next one,
/// and what the host does between two steps counts too. A step that ends after t_n is late. Up to `catch_up` seconds of
/// lateness are caught up by steps that do not sleep; what is beyond is dropped: the schedule is moved back by it.
template <PatientClock C = SleepingClock>
class BasicRealTimePace {
 public:
  using plays = role::Listener;
  using listens = Listens<stage::Begin, stage::Step>;

  /// Of all steps so far.
  struct Statistics {
    long steps = 0;  ///< that have ended
    long overruns = 0;     ///< steps whose own work took longer than h
    long late = 0;         ///< steps that ended after their t_n
    double p50 = 0 /**< s, median work of the latest steps */, p99 = 0 /**< s, 99 % of them work no longer */, max = 0;  ///< s, of all steps
    double worst_lateness = 0;  ///< s
    double dropped = 0;         ///< s by which the schedule was moved back in all
    double mean_period = 0;     ///< s from end to end of a step, sleep included
  };

  /// `keep` is the number of latest steps that p50 and p99 are of; their room is taken here, once.
  explicit BasicRealTimePace(double catch_up = 0, C clock = {}, int keep = 4096) : catch_up_(catch_up), clock_(clock) {
    inner::expect_at_least_zero("RealTimePace: catch_up", catch_up, "s");
    inner::expect_at_least_one("RealTimePace: keep", keep);
    work_.reserve(keep);
    keep_ = keep;
  }

  /// Sorts what is kept: not for every step.
  Statistics statistics() const {
    Statistics s = sums_;
    std::vector<double> sorted = work_;
    inner::sort(sorted);
    const auto share = [&](double p) {
      return sorted.empty() ? 0 : sorted[std::size_t(std::ceil(p * double(sorted.size()))) - 1];
    };
    s.p50 = share(0.5);
    s.p99 = share(0.99);
    s.mean_period = s.steps > 0 ? (ended_ - first_) / double(s.steps) : 0;
    return s;
  }

  void after(stage::Begin, const auto&) {
    began_ = clock_.now();
    if (sums_.steps == 0) first_ = due_ = began_;
  }

  void after(stage::Step, const auto& loop) {
    const double h = loop.step_size(), now = clock_.now(), work = now - began_;
    if (work_.size() < std::size_t(keep_))
      work_.push_back(work);
    else
      work_[std::size_t(sums_.steps % keep_)] = work;
    sums_.max = std::max(sums_.max, work);
    sums_.overruns += work > h;
    due_ += h;
    if (now > due_) {
      ++sums_.late;
      sums_.worst_lateness = std::max(sums_.worst_lateness, now - due_);
      const double beyond = now - due_ - catch_up_;
      if (beyond > 0) {
        sums_.dropped += beyond;
        due_ += beyond;
      }
    } else {
      clock_.sleep_until(due_);
    }
    ++sums_.steps;
    ended_ = clock_.now();
  }

 private:
  double catch_up_;
  C clock_;
  long keep_ = 0;
  std::vector<double> work_;
  Statistics sums_;
  double first_ = 0, began_ = 0, due_ = 0, ended_ = 0;  ///< s on the clock
};

/// On the clock that lets the thread sleep.
using RealTimePace = BasicRealTimePace<>;

}  // namespace delassus
