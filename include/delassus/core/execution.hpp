/// Who runs the parts of a step that do not depend on each other: one thread, or several.
#pragma once

#include <delassus/core/index.hpp>
#include <delassus/core/roles.hpp>

#include <concepts>

namespace delassus {

/// Two functions. `workers()` ≥ 1 is how many calls may run at once; it never changes. `run(tasks, f)` calls
/// f(task, worker) once for each task in [0, tasks), on any thread and in any order, and returns when all
/// calls have. Calls that run at once have different workers in [0, workers()). A task that throws: `run`
/// throws one of the exceptions after all calls have ended. f starts no `run` of its own.
template <class E>
concept Execution = Plays<E, role::Execution> && requires(const E& execution, void (*f)(Index, Index)) {
  { execution.workers() } -> std::convertible_to<Index>;
  execution.run(Index{}, f);
};

/// One thread, the caller's: what a loop takes where none is named.
struct Serial {
  using plays = role::Execution;
  static constexpr Index workers() { return 1; }
  /// Task by task, ascending.
  template <class F>
  static void run(Index tasks, F&& f) {
    for (Index task = 0; task < tasks; ++task) f(task, Index(0));
  }
};

}  // namespace delassus
