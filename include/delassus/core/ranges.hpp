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
/// one that is slow does not keep the others waiting.
inline Index tasks_of(Index count, Index least, Index workers) {
  const Index worth = count / least, most = 4 * workers;
  return worth < 1 ? 1 : worth < most ? worth : most;
}
/// The items of one of them.
inline Range range_of(Index count, Index task, Index tasks) {
  const auto bound = [&](Index k) { return Index((long long)(count)*k / tasks); };
  return {bound(task), bound(task + 1)};
}

}  // namespace delassus::inner
