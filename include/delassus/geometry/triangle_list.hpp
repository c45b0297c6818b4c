/// Triangles as a file holds them, of any surface or none.
#pragma once

#include <delassus/core/index.hpp>
#include <delassus/math/linear.hpp>

#include <array>
#include <vector>

namespace delassus {

/// Vertices, m, and triples of them. Unlike a `TriangleMesh`, which is made of such lists, it may be folded,
/// flat or torn: the convex hull of its vertices can still be taken.
struct TriangleList {
  std::vector<Vec3> vertices;                   ///< finite, m
  std::vector<std::array<Index, 3>> triangles;  ///< corners, in [0, number of vertices)
};

}  // namespace delassus
