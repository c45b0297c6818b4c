/// How many materials the loops of a process have: what a set of bodies can know of a material before any step.
#pragma once

#include <delassus/core/index.hpp>

#include <atomic>

namespace delassus::inner {

/// The largest number that a loop has given out. It decides about refusals alone, never about a result.
inline std::atomic<Index>& largest_material() {
  static std::atomic<Index> largest{0};
  return largest;
}

inline void note_materials(Index count) {
  Index before = largest_material();
  while (before < count && !largest_material().compare_exchange_weak(before, count)) {}
}

}  // namespace delassus::inner
