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

/// The triangles of `outer_faces`.
template <class Mesh>
std::vector<std::array<Index, 3>> surface(const Mesh& mesh) {
  std::vector<std::array<Index, 3>> triangles;
  for (const OuterFace& face : outer_faces(mesh)) triangles.push_back(face.triangle);
  return triangles;
}

}  // namespace delassus
