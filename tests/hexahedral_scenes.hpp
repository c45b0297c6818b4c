/// Meshes of hexahedra for the tests of several rooms.
#pragma once

#include <delassus/fem/hexahedral_fem.hpp>

#include "soft_scenes.hpp"

namespace soft_scenes {

/// The unit cube in n³ hexahedra, inner points moved by up to `jitter` of a cell.
inline HexahedralMesh bricks(Index n, double jitter = 0, unsigned seed = 1) {
  HexahedralMesh mesh = hexahedral_box({1, 1, 1}, {n, n, n});
  mesh.points = cube(n, jitter, seed).points;
  return mesh;
}

/// One hexahedron without a right angle or a plane face.
inline HexahedralMesh crooked_brick(unsigned seed = 3) {
  HexahedralMesh mesh = hexahedral_box({1, 1, 1}, {1, 1, 1});
  std::mt19937 random(seed);
  std::uniform_real_distribution<double> draw(-0.15, 0.15);
  for (Vec3& p : mesh.points)
    for (int k = 0; k < 3; ++k) p[k] += draw(random);
  return mesh;
}

}  // namespace soft_scenes
