/// A box cut into cells, hexahedra or each of them cut into tetrahedra.
#pragma once

#include <delassus/geometry/hexahedral_mesh.hpp>
#include <delassus/geometry/tetrahedral_mesh.hpp>

#include <array>
#include <span>
#include <string>
#include <utility>

namespace delassus {

/// How a cell is cut. six: around its long diagonal, all cells alike (Kuhn's subdivision). five: four corners
/// around one regular tetrahedron, neighbours mirrored; fewer elements, and no direction is preferred over
/// its mirror image.
enum class CellSplit { five, six };

namespace inner {

/// Corner c of a cell has its x, y, z offsets in the bits 0, 1, 2.
inline constexpr int five_tetrahedra[5][4] = {
    {0, 1, 2, 4}, {3, 2, 1, 7}, {5, 4, 7, 1}, {6, 7, 4, 2}, {1, 2, 4, 7}};
inline constexpr int six_tetrahedra[6][4] = {{0, 1, 3, 7}, {0, 1, 5, 7}, {0, 2, 3, 7},
                                             {0, 2, 6, 7}, {0, 4, 5, 7}, {0, 4, 6, 7}};

/// The points of a box in cells: (i, j, k) has number i + (cells[0] + 1)(j + (cells[1] + 1) k).
inline std::vector<Vec3> box_points(const Vec3& size, const std::array<Index, 3>& cells) {
  check_grid("box_mesh", std::array{size[0], size[1], size[2]}, cells);
  std::vector<Vec3> points;
  for (Index k = 0; k <= cells[2]; ++k)
    for (Index j = 0; j <= cells[1]; ++j)
      for (Index i = 0; i <= cells[0]; ++i)
        points.push_back({size[0] * i / cells[0], size[1] * j / cells[1], size[2] * k / cells[2]});
  return points;
}

}  // namespace inner

/// The box [0, size] (m) in cells[0] × cells[1] × cells[2] cells. Point (i, j, k) has number i + (cells[0] +
/// 1)(j + (cells[1] + 1) k).
inline TetrahedralMesh box_mesh(const Vec3& size, const std::array<Index, 3>& cells,
                                CellSplit split = CellSplit::six) {
  TetrahedralMesh mesh{inner::box_points(size, cells), {}};
  const auto point = [&](Index i, Index j, Index k) { return i + (cells[0] + 1) * (j + (cells[1] + 1) * k); };
  std::span<const int[4]> pieces = inner::six_tetrahedra;
  if (split == CellSplit::five) pieces = inner::five_tetrahedra;
  for (Index k = 0; k < cells[2]; ++k)
    for (Index j = 0; j < cells[1]; ++j)
      for (Index i = 0; i < cells[0]; ++i) {
        // A mirrored cell has its corners exchanged along x, so that its diagonals meet those of its
        // neighbours.
        const int mirror = split == CellSplit::five && (i + j + k) % 2 == 1 ? 1 : 0;
        for (const auto& corners : pieces) {
          auto& t = mesh.tetrahedra.emplace_back();
          for (int a = 0; a < 4; ++a) {
            const int c = corners[a] ^ mirror;
            t[a] = point(i + (c & 1), j + (c >> 1 & 1), k + (c >> 2 & 1));
          }
        }
      }
  return oriented(std::move(mesh));
}

/// The box [0, size] (m) in cells[0] × cells[1] × cells[2] hexahedra, its points numbered as those of
/// `box_mesh`.
inline HexahedralMesh hexahedral_box(const Vec3& size, const std::array<Index, 3>& cells) {
  HexahedralMesh mesh{inner::box_points(size, cells), {}};
  const Index row = cells[0] + 1, layer = row * (cells[1] + 1);
  for (Index k = 0; k < cells[2]; ++k)
    for (Index j = 0; j < cells[1]; ++j)
      for (Index i = 0; i < cells[0]; ++i) {
        const Index p = i + row * j + layer * k;
        mesh.hexahedra.push_back(
            {p, p + 1, p + row + 1, p + row, p + layer, p + layer + 1, p + layer + row + 1, p + layer + row});
      }
  return mesh;
}

}  // namespace delassus
