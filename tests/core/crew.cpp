// Threads that stay together for many short lists.
#include <delassus/core/crew.hpp>

#include "catch.hpp"

#include <stdexcept>
#include <thread>
#include <vector>

namespace crew_tests {

using delassus::Index;
using delassus::inner::Crew;

TEST_CASE("a crew runs each task of a list once, and what a task throws comes out when all have ended") {
  const int helpers = GENERATE(0, 1, 3);
  Crew crew;
  crew.assemble();
  REQUIRE(crew.leads());
  std::vector<std::thread> threads;
  for (int k = 0; k < helpers; ++k)
    threads.emplace_back([&] {
      if (!crew.leads()) crew.help();
    });
  for (int list = 0; list < 300; ++list) {
    std::atomic<int> ended = 0, runs[40] = {};
    const bool fails = list % 3 == 1;
    const auto task = [&](Index k) {
      ++runs[k];
      ++ended;
      if (fails && k % 7 == 3) throw std::runtime_error("task");
    };
    if (fails) CHECK_THROWS_WITH(crew.run(40, task), "task");
    else CHECK_NOTHROW(crew.run(40, task));
    CHECK(ended == 40);
    for (const std::atomic<int>& one : runs) CHECK(one == 1);
  }
  crew.dismiss();
  for (std::thread& thread : threads) thread.join();
}

}  // namespace crew_tests
