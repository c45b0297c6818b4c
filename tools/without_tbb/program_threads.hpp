/// What `--threads` of a program names, where oneTBB is not there.
#pragma once

#include <delassus/core/execution.hpp>
#include <delassus/core/expect.hpp>

/// One thread; more are refused.
inline delassus::Serial program_threads(int count) {
  DELASSUS_EXPECT(count == 1, "--threads: this program was built without oneTBB; install libtbb-dev and build it again");
  return {};
}
