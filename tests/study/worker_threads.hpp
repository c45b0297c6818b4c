/// A scheduler of threads that wait for work: the concept Execution, with nothing but the standard library.
#pragma once

#include <delassus/core/execution.hpp>
#include <delassus/core/index.hpp>

#include <condition_variable>
#include <exception>
#include <memory>
#include <mutex>
#include <thread>
#include <utility>
#include <vector>

namespace delassus {

/// Tasks go to whoever is free; the caller is worker 0. Copies share their threads, one `run` at a time.
class WorkerThreads {
 public:
  using plays = role::Execution;
  explicit WorkerThreads(Index workers = Index(std::thread::hardware_concurrency())) : pool_(std::make_shared<Pool>(workers)) {}

  Index workers() const { return Index(pool_->threads.size()) + 1; }
  template <class F>
  void run(Index tasks, F&& f) const {
    pool_->run(tasks, [](void* call, Index task, Index worker) { (*static_cast<std::remove_reference_t<F>*>(call))(task, worker); },
               const_cast<void*>(static_cast<const void*>(&f)));
  }

 private:
  using Call = void (*)(void*, Index, Index);

  struct Pool {
    explicit Pool(Index workers) {
      for (Index w = 1; w < workers; ++w) threads.emplace_back([this, w] { wait_for_work(w); });
    }
    ~Pool() {
      {
        const std::lock_guard lock(mutex);
        is_over = true;
      }
      begins.notify_all();
      for (std::thread& t : threads) t.join();
    }

    void run(Index count, Call function, void* argument) {
      std::unique_lock lock(mutex);
      tasks = count, next = 0, call = function, what = argument, thrown = nullptr;
      ++round;
      begins.notify_all();
      work(lock, 0);
      ends.wait(lock, [&] { return busy == 0; });
      if (thrown) std::rethrow_exception(std::exchange(thrown, nullptr));
    }
    void wait_for_work(Index worker) {
      std::unique_lock lock(mutex);
      for (long seen = 0;;) {
        begins.wait(lock, [&] { return is_over || round != seen; });
        if (is_over) return;
        seen = round;
        work(lock, worker);
        if (busy == 0) ends.notify_one();
      }
    }
    void work(std::unique_lock<std::mutex>& lock, Index worker) {
      ++busy;
      while (next < tasks) {
        const Index task = next++;
        lock.unlock();
        std::exception_ptr mine;
        try {
          call(what, task, worker);
        } catch (...) {
          mine = std::current_exception();
        }
        lock.lock();
        if (mine && !thrown) thrown = mine;
      }
      --busy;
    }

    std::mutex mutex;
    std::condition_variable begins, ends;
    std::vector<std::thread> threads;
    Index tasks = 0, next = 0, busy = 0;
    long round = 0;
    bool is_over = false;
    Call call = nullptr;
    void* what = nullptr;
    std::exception_ptr thrown;
  };

  std::shared_ptr<Pool> pool_;
};
static_assert(Execution<WorkerThreads>);

}  // namespace delassus
