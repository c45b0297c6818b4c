/// What every mesh of cells over points must hold, whatever its cells are.
#pragma once

#include <delassus/core/expect.hpp>
#include <delassus/core/index.hpp>
#include <delassus/math/linear.hpp>

#include <array>
#include <cstddef>
#include <limits>
#include <string>
#include <vector>

namespace delassus::inner {

template <class Mesh>
std::string name_of_cell(const std::string& who, Index e) {
  return who + ": " + Mesh::cell + " #" + std::to_string(e);
}

/// Refuses cells that name points which are not there.
template <class Mesh>
void check_corners(const Mesh& mesh, const std::string& who) {
  const Index count = Index(mesh.points.size());
  for (Index e = 0; e < Index(mesh.cells().size()); ++e)
    for (const Index i : mesh.cells()[e])
      DELASSUS_EXPECT(i >= 0 && i < count, name_of_cell<Mesh>(who, e) + " names point " + std::to_string(i) +
                                               ", but the mesh has points 0 to " + std::to_string(count - 1));
}

/// Refuses a mesh without cells, cells that name points which are not there, and points that are not finite or in no cell.
template <class Mesh>
void check_points(const Mesh& mesh, const std::string& who) {
  DELASSUS_EXPECT(!mesh.cells().empty(), who + ": the mesh has no " + Mesh::cell);
  check_corners(mesh, who);
  std::vector<char> is_used(mesh.points.size(), 0);
  for (const auto& cell : mesh.cells())
    for (const Index i : cell) is_used[i] = 1;
  for (std::size_t i = 0; i < mesh.points.size(); ++i) {
    const std::string name = who + ": point #" + std::to_string(i);
    DELASSUS_EXPECT(is_finite(mesh.points[i]), name + " of the mesh is not finite");
    DELASSUS_EXPECT(is_used[i], name + " belongs to no " + Mesh::cell + "; take it out of the mesh");
  }
}

/// Refuses a rectangle or a box of cells that has no size along an edge (m), no cells along it, or too many points.
template <std::size_t N>
void check_grid(const std::string& who, const std::array<double, N>& size, const std::array<Index, N>& cells) {
  double points = 1;
  for (std::size_t k = 0; k < N; ++k) {
    expect_positive(who + ": the size", size[k], "m");
    DELASSUS_EXPECT(cells[k] > 0, who + ": the number of cells " + std::to_string(cells[k]) + " must be > 0");
    points *= cells[k] + 1.0;
  }
  DELASSUS_EXPECT(points <= std::numeric_limits<Index>::max(),
                  who + ": " + text(points) + " points are more than an index counts");
}

}  // namespace delassus::inner
