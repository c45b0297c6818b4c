/// Tetrahedral meshes: checks, volumes, the outer surface.
#pragma once

#include <delassus/core/cmath.hpp>
#include <delassus/core/expect.hpp>
#include <delassus/core/index.hpp>
#include <delassus/geometry/inner/cell_sides.hpp>
#include <delassus/geometry/inner/check_cells.hpp>
#include <delassus/geometry/inner/corners.hpp>
#include <delassus/geometry/outer_face.hpp>
#include <delassus/math/linear.hpp>

#include <array>
#include <string>
#include <utility>
#include <vector>

namespace delassus {

/// Points (m) and tetrahedra of four points each, ordered so that (x₁ − x₀) · ((x₂ − x₀) × (x₃ − x₀)) > 0.
struct TetrahedralMesh {
  std::vector<Vec3> points;                      ///< m
  std::vector<std::array<Index, 4>> tetrahedra;  ///< by numbers of points

  static constexpr const char* cell = "tetrahedron";  ///< its word for an element in messages
  static constexpr bool has_shares = true;  ///< places in an element are the shares of its corners 1, 2, 3
  const auto& cells() const { return tetrahedra; }  ///< by the name that all meshes share
  auto& cells() { return tetrahedra; }  ///< the same, to change
};

/// Of tetrahedron e, m³; negative where its points are ordered inside out.
inline double volume(const TetrahedralMesh& mesh, Index e) {
  const auto& t = mesh.tetrahedra[e];
  const Vec3 &o = mesh.points[t[0]], a = mesh.points[t[1]] - o, b = mesh.points[t[2]] - o,
             c = mesh.points[t[3]] - o;
  return dot(a, cross(b, c)) / 6;
}

namespace inner {

/// The four faces of a tetrahedron, each seen from outside against the clock.
inline constexpr int tetrahedron_face[4][3] = {{1, 2, 3}, {0, 3, 2}, {0, 1, 3}, {0, 2, 1}};

}  // namespace inner

/// Refuses a mesh that is no body: points that are not finite or in no tetrahedron, and numbers of points that
/// are not there. Refuses tetrahedra that are flat (height below 1e-9 of the size), inside out or there twice.
inline void check_mesh(const TetrahedralMesh& mesh, const std::string& who) {
  inner::check_points(mesh, who);
  for (Index e = 0; e < Index(mesh.tetrahedra.size()); ++e) {
    const std::string name = inner::name_of_cell<TetrahedralMesh>(who, e);
    const double V = volume(mesh, e), longest = inner::longest_edge(mesh, e);
    DELASSUS_EXPECT(std::abs(6 * V) > 1e-9 * longest * longest * longest,
                    name + " is flat: its volume is " + inner::text(V) + " m³, its longest edge " +
                        inner::text(longest) + " m");
    DELASSUS_EXPECT(V > 0, name + " is inside out, its volume is " + inner::text(V) +
                               " m³; exchange two of its points, as oriented(mesh) does");
  }
  inner::check_sides(mesh, inner::tetrahedron_face, who, "tetrahedra");
}

/// The same mesh with two points exchanged in every tetrahedron that is inside out.
inline TetrahedralMesh oriented(TetrahedralMesh mesh) {
  inner::check_corners(mesh, "oriented");
  for (Index e = 0; e < Index(mesh.tetrahedra.size()); ++e)
    if (volume(mesh, e) < 0) std::swap(mesh.tetrahedra[e][2], mesh.tetrahedra[e][3]);
  return mesh;
}

/// Where corner k is in the coordinates by which an element weighs its corners: their shares but for the
/// first one's.
inline Vec3 place_of_corner(const TetrahedralMesh&, int k) {
  return k > 0 ? unit_axis(k - 1) : Vec3(zero<Vec3>());
}

/// The triangles that belong to one tetrahedron only, in the order of the tetrahedra.
inline std::vector<OuterFace> outer_faces(const TetrahedralMesh& mesh) {
  std::vector<OuterFace> out;
  for (const auto& side : inner::outer_sides(mesh, inner::tetrahedron_face)) out.push_back({side.around, side.element});
  return out;
}

}  // namespace delassus
