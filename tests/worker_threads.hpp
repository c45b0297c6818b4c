/// A scheduler as a host may bring its own: threads that take tasks from a counter.
#pragma once

#include <delassus/step/in_parallel.hpp>

#include <atomic>
#include <thread>
#include <vector>

namespace delassus {

struct WorkerThreads : InParallel {
  int count = 4;

  Index workers() const { return count; }
  template <class F>
  void run(Index tasks, F&& f) const {
    std::atomic<Index> next{0};
    const auto work = [&](Index worker) {
      for (Index task; (task = next++) < tasks;) f(task, worker);
    };
    std::vector<std::thread> threads;
    for (Index worker = 1; worker < count; ++worker) threads.emplace_back(work, worker);
    work(0);
    for (std::thread& t : threads) t.join();
  }
};

}  // namespace delassus
