/// Clocks: what waits, limits or paces takes one as a parameter, so that a test can say what time it is.
#pragma once

#include <concepts>
#include <ctime>

#ifndef CLOCK_MONOTONIC
#include <chrono>  // ten MB of a compiler, so only where the C library has no such clock
#endif

namespace delassus {

/// `now()` is in seconds and never goes back; where zero is does not matter. Copies tell the same time.
template <class C>
concept Clock = std::copyable<C> && requires(const C clock) {
  { clock.now() } -> std::same_as<double>;
};

/// The wall clock that no one sets.
struct SteadyClock {
  double now() const {
#ifdef CLOCK_MONOTONIC
    ::timespec time;  // of the C library: not every platform has it in std
    ::clock_gettime(CLOCK_MONOTONIC, &time);
    return double(time.tv_sec) + 1e-9 * double(time.tv_nsec);
#else
    return std::chrono::duration<double>(std::chrono::steady_clock::now().time_since_epoch()).count();
#endif
  }
};

/// A clock that shows `*time`, and goes on by `tick` at each look, for tests
/// that must be exact, and for replays.
struct ScriptedClock {
  double* time = nullptr;  ///< s; must outlive the clock
  double tick = 0;         ///< s per reading
  double now() const {
    const double t = *time;
    *time += tick;
    return t;
  }
  void sleep_until(double t) const { *time = *time < t ? t : *time; }
};

static_assert(Clock<SteadyClock> && Clock<ScriptedClock>);

}  // namespace delassus
