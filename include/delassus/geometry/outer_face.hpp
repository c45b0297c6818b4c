/// The outer surface of a mesh of elements.
#pragma once

#include <delassus/core/index.hpp>

#include <array>
#include <vector>

namespace delassus {

/// A triangle of the outer surface, its normal outwards, and the element behind it. A sheet has two sides.
struct OuterFace {
  std::array<Index, 3> triangle;
  Index element;
  bool is_back = false;  ///< of the second side
};

inline std::vector<std::array<Index, 3>> triangles_of(const std::vector<OuterFace>& faces) {
  std::vector<std::array<Index, 3>> triangles;
  for (const OuterFace& face : faces) triangles.push_back(face.triangle);
  return triangles;
}

}  // namespace delassus
