/// How a user names a body: by place, generation and owner, so that a stale or foreign name is noticed.
#pragma once

#include <delassus/core/index.hpp>

#include <atomic>
#include <cstdint>
#include <string>

namespace delassus {

/// Names one body of a set. `owner` is the set's own number; `generation` counts how often the place was reused.
template <class Set>
struct Handle {
  Index index = -1;              ///< of its block in the set; −1: none
  std::uint32_t generation = 0;  ///< of the block when the body was added
  std::uint32_t owner = 0;       ///< 0: never assigned

  friend bool operator==(const Handle&, const Handle&) = default;
};

namespace inner {

/// A number no other set of this process has. It never enters a computation, only comparisons of handles.
inline std::uint32_t next_owner() {
  static std::atomic<std::uint32_t> count{0};
  return ++count;
}

/// What is wrong with the handle of a `kind`: one that was declared and never given a value has no owner.
inline std::string wrong_handle(std::uint32_t owner, const std::string& kind, const std::string& otherwise) {
  return owner == 0 ? "this " + kind + " handle was never assigned; keep the one that add(...) returns" : otherwise;
}

}  // namespace inner
}  // namespace delassus
