/// The faces of the cells of a mesh: which two cells share, and which are outside.
#pragma once

#include <delassus/core/expect.hpp>
#include <delassus/core/index.hpp>
#include <delassus/core/sort.hpp>

#include <algorithm>
#include <array>
#include <cstddef>
#include <string>
#include <vector>

namespace delassus::inner {

/// A face of N points of a cell.
template <std::size_t N>
struct CellSide {
  std::array<Index, N> around;    ///< its points as they lie around it
  std::array<Index, N + 1> face;  ///< its points sorted, then the way around
  Index number;                   ///< of all faces, cell by cell
  Index element;

  bool has_points_of(const CellSide& other) const {
    return std::equal(face.begin(), face.end() - 1, other.face.begin());
  }
};

/// The faces of all cells, those of the same points beside each other. `faces`: the corners of those of one cell, each seen
/// from outside against the clock.
template <class Mesh, std::size_t F, std::size_t N>
std::vector<CellSide<N>> sorted_sides(const Mesh& mesh, const int (&faces)[F][N]) {
  std::vector<CellSide<N>> sides;
  sides.reserve(F * mesh.cells().size());
  for (Index e = 0; e < Index(mesh.cells().size()); ++e)
    for (const auto& corners : faces) {
      auto& [around, face, number, element] = sides.emplace_back();
      for (std::size_t k = 0; k < N; ++k) around[k] = face[k] = mesh.cells()[e][corners[k]];
      const auto least = std::min_element(around.begin(), around.end()) - around.begin();
      face[N] = around[(least + 1) % N] < around[(least + N - 1) % N] ? 0 : 1;
      inner::sort(face.data(), face.data() + face.size() - 1);
      number = Index(sides.size()) - 1;
      element = e;
    }
  inner::sort(sides, [](const auto& a, const auto& b) {
    return a.face != b.face ? a.face < b.face : a.number < b.number;
  });
  return sides;
}

/// Those that belong to one cell only, in the order of the cells.
template <class Mesh, std::size_t F, std::size_t N>
std::vector<CellSide<N>> outer_sides(const Mesh& mesh, const int (&faces)[F][N]) {
  const auto sides = sorted_sides(mesh, faces);
  std::vector<CellSide<N>> outer;
  for (std::size_t k = 0, next = 0; k < sides.size(); k = next) {
    for (next = k; next < sides.size() && sides[next].has_points_of(sides[k]);) ++next;
    if (next == k + 1) outer.push_back(sides[k]);
  }
  inner::sort(outer, [](const auto& a, const auto& b) { return a.number < b.number; });
  return outer;
}

/// Refuses cells that lie on the same side of a face, as one that is named twice does. `cells`: more than one of them.
template <class Mesh, std::size_t F, std::size_t N>
void check_sides(const Mesh& mesh, const int (&faces)[F][N], const std::string& who, const char* cells) {
  const auto sides = sorted_sides(mesh, faces);
  for (std::size_t k = 1; k < sides.size(); ++k)
    DELASSUS_EXPECT(sides[k - 1].face != sides[k].face,
                    who + ": " + cells + " #" + std::to_string(sides[k - 1].element) + " and #" +
                        std::to_string(sides[k].element) + " lie on the same side of a face; name each once");
}

}  // namespace delassus::inner
