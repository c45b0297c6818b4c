/// Several threads for a loop, by oneTBB. Link `delassus::tbb`.
#pragma once

#include <delassus/core/expect.hpp>
#include <delassus/core/index.hpp>
#include <delassus/step/in_parallel.hpp>

#include <algorithm>
#include <memory>
#include <string>

#include <oneapi/tbb/global_control.h>
#include <oneapi/tbb/parallel_for.h>
#include <oneapi/tbb/partitioner.h>
#include <oneapi/tbb/task_arena.h>

namespace delassus {

/// `AnimationLoop{..., Threads{4}}`: parts of a step run on up to four threads, the caller's among them.
/// Which parts says `InParallel`. The bits do not depend on the number. Copies share their threads; loops
/// with the same `Threads` may step at once.
///
/// There are no more than oneTBB allows a program: one a processor, where a `tbb::global_control` of the host
/// does not say otherwise.
class Threads : public InParallel {
 public:
  /// 0: one a processor. Throws InvalidArgument outside of 0 … 1024.
  explicit Threads(int count = 0) : arena_(std::make_shared<oneapi::tbb::task_arena>(checked(count))) {}
  /// A copy, of which neither is ever without threads.
  Threads(const Threads&) = default;
  Threads& operator=(const Threads&) = default;

  /// How many threads work at once, at least 1.
  Index workers() const { return Index(arena_->max_concurrency()); }
  template <class F>
  void run(Index tasks, F&& f) const {
    if (tasks <= 1 || workers() == 1) return Serial::run(tasks, f);
    arena_->execute([&] {
      oneapi::tbb::parallel_for(
          Index(0), tasks,
          [&](Index task) { f(task, Index(oneapi::tbb::this_task_arena::current_thread_index())); },
          oneapi::tbb::simple_partitioner());
    });
  }

 private:
  static int checked(int count) {
    DELASSUS_EXPECT(count >= 0 && count <= 1024, "Threads: " + std::to_string(count) +
                                                     " threads; take 1 to 1024, or 0 for one a processor");
    using oneapi::tbb::global_control;
    const int most = int(global_control::active_value(global_control::max_allowed_parallelism));
    return count > 0 ? std::min(count, most) : most;
  }

  std::shared_ptr<oneapi::tbb::task_arena> arena_;
};

}  // namespace delassus
