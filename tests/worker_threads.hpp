/// A scheduler as a host may bring its own: threads that take tasks from a counter.
#pragma once

#include <delassus/step/in_parallel.hpp>

#include <atomic>
#include <future>
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
    std::vector<std::future<void>> threads;
    for (Index worker = 1; worker < count; ++worker)
      threads.push_back(std::async(std::launch::async, work, worker));
    work(0);
    for (std::future<void>& thread : threads) thread.get();
  }
};

}  // namespace delassus
