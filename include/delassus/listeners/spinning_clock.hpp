/// A clock that waits to the microsecond: it sleeps until shortly before, and spins the rest.
#pragma once

#include <delassus/listeners/real_time_pace.hpp>

namespace delassus {

/// The system wakes a sleeper late, by tens of microseconds and now and then by more; `tail` seconds before the moment this
/// clock stops sleeping and looks at the time instead. That costs a core `tail` seconds per wait.
struct SpinningClock : SteadyClock {
  double tail = 150e-6;  ///< s

  /// `t` in s on the steady clock.
  void sleep_until(double t) const {
    SleepingClock{}.sleep_until(t - tail);
    while (now() < t) {
    }
  }
};

static_assert(PatientClock<SpinningClock>);

}  // namespace delassus
