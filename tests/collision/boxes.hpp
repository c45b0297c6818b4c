/// The pairs of boxes by brute force.
#pragma once

#include <delassus/collision/broad_phase.hpp>

#include <vector>

namespace samples {

using namespace delassus;

/// Sorted.
inline std::vector<CandidatePair> brute_force(const std::vector<Aabb>& boxes) {
  std::vector<CandidatePair> pairs;
  for (Index i = 0; i < Index(boxes.size()); ++i)
    for (Index j = i + 1; j < Index(boxes.size()); ++j)
      if (!boxes[i].is_empty() && !boxes[j].is_empty() && boxes[i].intersects(boxes[j]))
        pairs.push_back({i, j});
  return pairs;
}

}  // namespace samples
