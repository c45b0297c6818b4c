/// A scheduler as a host may bring its own: threads that take tasks from a counter.
#pragma once

#include <delassus/step/in_parallel.hpp>

#include <atomic>
#include <future>
#include <type_traits>
#include <vector>

namespace delassus {

/// One function for all that is run, so that the compiler meets `std::async` once a file.
struct TaskOfWorker {
  void* who;
  void (*run)(void* who, Index task, Index worker);
};
inline void run_on_threads(int count, Index tasks, TaskOfWorker f) {
  std::atomic<Index> next{0};
  const auto work = [&](Index worker) {
    for (Index task; (task = next++) < tasks;) f.run(f.who, task, worker);
  };
  std::vector<std::future<void>> threads;
  for (Index worker = 1; worker < count; ++worker) threads.push_back(std::async(std::launch::async, work, worker));
  work(0);
  for (std::future<void>& thread : threads) thread.get();
}

struct WorkerThreads : InParallel {
  int count = 4;

  Index workers() const { return count; }
  template <class F>
  void run(Index tasks, F&& f) const {
    using Called = std::remove_reference_t<F>;
    void* const who = const_cast<std::remove_const_t<Called>*>(&f);
    run_on_threads(count, tasks, {who, [](void* called, Index task, Index worker) { (*static_cast<Called*>(called))(task, worker); }});
  }
};

}  // namespace delassus
