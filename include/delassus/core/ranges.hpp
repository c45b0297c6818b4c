/// How a list is cut into tasks.
#pragma once

#include <delassus/core/index.hpp>

namespace delassus::inner {

/// The numbers first … last − 1.
struct Range {
  Index first, last;
  Index count() const { return last - first; }
};

/// How many tasks `count` items make that are worth one with `least` of them: at most four a worker, so that
/// one that is slow does not keep the others waiting. One for one worker, who has nobody to wait for.
inline Index tasks_of(Index count, Index least, Index workers) {
  if (workers == 1) return 1;
  const Index worth = count / least, most = 4 * workers;
  return worth < 1 ? 1 : worth < most ? worth : most;
}
/// The items of one of them.
inline Range range_of(Index count, Index task, Index tasks) {
  const auto bound = [&](Index k) { return Index((long long)(count)*k / tasks); };
  return {bound(task), bound(task + 1)};
}

/// Calls of f(range) for items that do not depend on each other: one call by the one who asks.
struct OneRange {
  template <class F>
  [[gnu::always_inline]] void operator()(Index count, Index, const F& f) const {
    f(Range{0, count});
  }
};
/// Or calls by the workers of an `Execution`, of at least `least` items each.
template <class E>
struct SharedRanges {
  const E& execution;

  template <class F>
  void operator()(Index count, Index least, const F& f) const {
    const Index tasks = tasks_of(count, least, execution.workers());
    if (tasks == 1) return f(Range{0, count});
    execution.run(tasks, [&](Index task, Index) { f(range_of(count, task, tasks)); });
  }
};
template <class E>
SharedRanges(const E&) -> SharedRanges<E>;

}  // namespace delassus::inner
