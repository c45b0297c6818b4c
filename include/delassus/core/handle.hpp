/// How a user names a body: by place, generation and owner, so that a stale or foreign name is noticed.
#pragma once

#include <delassus/core/index.hpp>

#include <atomic>
#include <cstdint>

namespace delassus {

/// Names one body of a set. `owner` is the set's own number; `generation` counts how often the place was reused.
template <class Set>
struct Handle {
  Index index = -1;
  std::uint32_t generation = 0;
  std::uint32_t owner = 0;

  friend bool operator==(const Handle&, const Handle&) = default;
};

namespace inner {

/// A number no other set of this process has. It never enters a computation, only comparisons of handles.
inline std::uint32_t next_owner() {
  static std::atomic<std::uint32_t> count{0};
  return ++count;
}

}  // namespace inner
}  // namespace delassus
