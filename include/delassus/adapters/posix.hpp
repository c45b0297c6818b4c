/// What POSIX offers a thread that must not be late, or is timed: a fixed priority, memory that stays, a core and a clock of its own.
#pragma once

#include <pthread.h>
#include <sched.h>
#include <sys/mman.h>
#include <time.h>

#include <algorithm>

namespace delassus {

/// The calling thread runs before all others until it waits: SCHED_FIFO, `priority` 1 (low) … 99. False when the system
/// refuses, which it does without CAP_SYS_NICE or an `rtprio` limit (/etc/security/limits.conf). Threads inherit it.
inline bool set_realtime_priority(int priority) {
  sched_param parameters{};
  parameters.sched_priority =
      std::clamp(priority, sched_get_priority_min(SCHED_FIFO), sched_get_priority_max(SCHED_FIFO));
  return pthread_setschedparam(pthread_self(), SCHED_FIFO, &parameters) == 0;
}

/// No page of this process, present or future, is swapped out or comes late: mlockall. False when the system refuses, which it
/// does without CAP_IPC_LOCK or a `memlock` limit. Call it before the threads start.
inline bool lock_memory() { return mlockall(MCL_CURRENT | MCL_FUTURE) == 0; }

/// Processor time of the calling thread, s, whatever else the machine does meanwhile. Reading it takes a few hundred ns.
struct ThreadClock {
  double now() const {
    timespec t{};
    clock_gettime(CLOCK_THREAD_CPUTIME_ID, &t);
    return double(t.tv_sec) + 1e-9 * double(t.tv_nsec);
  }
};

#if defined(__linux__)
/// The calling thread stays on one core, 0 … . False when there is no such core. Linux alone.
inline bool stay_on_core(int core) {
  if (core < 0 || core >= CPU_SETSIZE) return false;
  cpu_set_t cores;
  CPU_ZERO(&cores);
  CPU_SET(core, &cores);
  return pthread_setaffinity_np(pthread_self(), sizeof cores, &cores) == 0;
}
#endif

}  // namespace delassus
