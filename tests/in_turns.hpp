/// A scheduler of three workers on one thread, in turns: who does what is the same in each run.
#pragma once

#include <delassus/step/in_parallel.hpp>

namespace delassus {

struct InTurns : InParallel {
  Index workers() const { return 3; }
  template <class F>
  void run(Index tasks, F&& f) const {
    for (Index task = 0; task < tasks; ++task) f(task, task % 3);
  }
};

}  // namespace delassus
