/// Threads that stay together for many short lists of tasks.
#pragma once

#include <delassus/core/index.hpp>

#include <atomic>
#include <cstdint>
#include <exception>
#include <thread>
#include <utility>

namespace delassus::inner {

/// A leader runs lists of tasks one after the other; helpers take tasks of the list that is open until
/// `dismiss`. Who takes which is chance. The leader needs no helper: it waits for tasks that were taken,
/// never for somebody to come. A list that takes a few microseconds is worth it, which a scheduler's own
/// start is not.
class Crew {
 public:
  Crew() = default;
  /// A copy is one without helpers.
  Crew(const Crew&) {}
  Crew& operator=(const Crew&) { return *this; }

  /// Before anybody comes.
  void assemble() {
    is_led_.store(false, std::memory_order_relaxed);
    is_dismissed_.store(false, std::memory_order_relaxed);
  }
  /// Whether the one who asks leads: the first does, since a scheduler may begin with any task.
  bool leads() { return !is_led_.exchange(true, std::memory_order_relaxed); }
  /// The helpers go.
  void dismiss() { is_dismissed_.store(true, std::memory_order_release); }

  /// f(task) for each task in [0, tasks); the leader's. Pre: tasks < 2²⁰. Throws what a task threw, the first
  /// of them, when all have ended.
  template <class F>
  void run(Index tasks, const F& f) {
    if (tasks <= 1) {
      if (tasks == 1) f(Index(0));
      return;
    }
    with_ = &f;
    call_ = [](const void* with, Index task) { (*static_cast<const F*>(with))(task); };
    ended_.store(0, std::memory_order_relaxed);
    open_.store(++list_ << 40 | std::uint64_t(tasks) << 20, std::memory_order_release);
    while (take()) {
    }
    for (int waits = 0; ended_.load(std::memory_order_acquire) != tasks; ++waits) rest(waits);
    if (has_failed_.load(std::memory_order_relaxed)) throw_failure();
  }
  /// Takes tasks until the leader dismisses the helpers.
  void help() {
    for (int waits = 0; !is_dismissed_.load(std::memory_order_acquire); ++waits) {
      if (take())
        waits = 0;
      else
        rest(waits);
    }
  }

 private:
  /// One task of the open list, if there is one left. Who takes one knows that its list stays until it has
  /// ended.
  bool take() {
    constexpr std::uint64_t low = (1u << 20) - 1;
    std::uint64_t open = open_.load(std::memory_order_acquire);
    do {
      if ((open & low) >= (open >> 20 & low)) return false;
    } while (
        !open_.compare_exchange_weak(open, open + 1, std::memory_order_acquire, std::memory_order_acquire));
    try {
      call_(with_, Index(open & low));
    } catch (...) {
      if (!has_failed_.exchange(true, std::memory_order_relaxed)) failure_ = std::current_exception();
    }
    ended_.fetch_add(1, std::memory_order_release);
    return true;
  }
  void throw_failure() {
    has_failed_.store(false, std::memory_order_relaxed);
    std::rethrow_exception(std::exchange(failure_, nullptr));
  }
  /// A processor that others want is given up after some microseconds.
  static void rest(int waits) {
    if (waits > 200)
      std::this_thread::yield();
    else
      std::atomic_signal_fence(std::memory_order_seq_cst);
  }

  std::atomic<std::uint64_t> open_{0};  ///< number of the list, of its tasks, of the next one
  std::atomic<Index> ended_{0};
  std::atomic<bool> is_dismissed_{true}, is_led_{false}, has_failed_{false};
  std::exception_ptr failure_;  ///< of the one who set has_failed_, until all tasks have ended
  std::uint64_t list_ = 0;
  const void* with_ = nullptr;
  void (*call_)(const void*, Index) = nullptr;
};

}  // namespace delassus::inner
