#include <delassus/listeners/spinning_clock.hpp>

#include "catch.hpp"

using namespace delassus;

TEST_CASE("a spinning clock returns at the moment it was asked for, never before, and at once when that is past") {
  const SpinningClock clock{.tail = 1e-4};
  for (const double wait : {2e-3, 5e-5, 0.0, -1.0}) {
    const double until = clock.now() + wait;
    clock.sleep_until(until);
    REQUIRE(clock.now() >= until);
  }
}

TEST_CASE("a loop can be paced by a spinning clock") {
  static_assert(PatientClock<SpinningClock>);
  BasicRealTimePace<SpinningClock> pace;
  SUCCEED();
}
