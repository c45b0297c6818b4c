#include <delassus/adapters/posix.hpp>

#include "catch.hpp"

#include <thread>

TEST_CASE("what the system refuses is said, and a thread that asks in vain goes on") {
  bool stayed = false, went_nowhere = true;
  std::thread thread([&] {
    delassus::set_realtime_priority(10);  // either answer is right: it is the system's
    stayed = delassus::stay_on_core(sched_getcpu());  // where it is it may stay
    went_nowhere = delassus::stay_on_core(-1) || delassus::stay_on_core(1 << 20);
  });
  thread.join();
  CHECK(stayed);
  CHECK_FALSE(went_nowhere);
}
