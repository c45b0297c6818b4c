/// Sheets of triangles: a surface with a thickness, its checks, and rectangles of it.
#pragma once

#include <delassus/core/cmath.hpp>
#include <delassus/core/expect.hpp>
#include <delassus/core/index.hpp>
#include <delassus/core/sort.hpp>
#include <delassus/geometry/inner/check_cells.hpp>
#include <delassus/geometry/inner/surface_topology.hpp>
#include <delassus/geometry/outer_face.hpp>
#include <delassus/geometry/triangle.hpp>
#include <delassus/geometry/triangle_mesh.hpp>
#include <delassus/math/linear.hpp>

#include <algorithm>
#include <array>
#include <cstddef>
#include <limits>
#include <string>
#include <vector>

namespace delassus {

/// Points (m) of the middle surface and triangles of three points each, all turned to the same side; at most
/// two have an edge. It may be open, and need not be flat.
struct SheetMesh {
  std::vector<Vec3> points;                     ///< of the middle surface, m
  std::vector<std::array<Index, 3>> triangles;  ///< by numbers of points
  double thickness = 1e-3;  ///< m

  static constexpr const char* cell = "triangle";  ///< its word for an element in messages
  const auto& cells() const { return triangles; }  ///< by the name that all meshes share
  auto& cells() { return triangles; }  ///< the same, to change
};

/// m².
inline double area(const SheetMesh& mesh, Index e) {
  const auto& t = mesh.triangles[e];
  const Vec3& o = mesh.points[t[0]];
  return 0.5 * norm(cross(mesh.points[t[1]] - o, mesh.points[t[2]] - o));
}
/// Of triangle e, m³.
inline double volume(const SheetMesh& mesh, Index e) { return mesh.thickness * area(mesh, e); }

/// Refuses a mesh that is no sheet: a thickness that is none, points that are not finite or in no triangle, and
/// numbers of points that are not there. Refuses triangles without area (height below 1e-6 of the longest edge),
/// two triangles of the same points, and edges of three triangles or of two that are turned to different sides.
inline void check_mesh(const SheetMesh& mesh, const std::string& who) {
  inner::check_points(mesh, who);
  inner::expect_positive(who + ": the thickness", mesh.thickness, "m");
  for (Index e = 0; e < Index(mesh.triangles.size()); ++e) {
    const auto& t = mesh.triangles[e];
    const std::string name = inner::name_of_cell<SheetMesh>(who, e);
    DELASSUS_EXPECT(!is_zero(inner::triangle_normal(mesh.points[t[0]], mesh.points[t[1]], mesh.points[t[2]])),
                    name + " has no area (height <= 1e-6 of its longest edge); drop it or join its points");
  }
  std::vector<std::array<Index, 4>> sorted;  // the points of a triangle in order, and its number
  for (const auto& t : mesh.triangles) {
    sorted.push_back({t[0], t[1], t[2], Index(sorted.size())});
    inner::sort(sorted.back().data(), sorted.back().data() + sorted.back().size() - 1);
  }
  inner::sort(sorted);
  for (std::size_t k = 1; k < sorted.size(); ++k) {
    const auto &a = sorted[k - 1], &b = sorted[k];
    DELASSUS_EXPECT(!std::equal(a.begin(), a.end() - 1, b.begin()),
                    who + ": triangles #" + std::to_string(a[3]) + " and #" + std::to_string(b[3]) +
                        " have the same points; drop one of them, since a sheet has both its sides anyway");
  }
  const inner::SurfaceTopology topology(mesh.triangles, Index(mesh.points.size()));
  for (const inner::SharedEdge& e : topology.faults()) {
    const std::string which =
        who + ": triangles #" + std::to_string(e.first) + " and #" + std::to_string(e.second);
    DELASSUS_EXPECT(e.third < 0, which + " share an edge with #" + std::to_string(e.third) +
                                     "; at most two may, so make each sheet a body and tie them by joints");
    inner::refuse(which + " are turned to different sides; exchange two points of one of them");
  }
}

/// Where corner k is in the coordinates by which an element weighs its corners.
inline Vec3 place_of_corner(const SheetMesh&, int k) { return k > 0 ? unit_axis(k - 1) : Vec3(zero<Vec3>()); }

/// Its own triangles, one side of them.
inline const std::vector<std::array<Index, 3>>& surface(const SheetMesh& mesh) { return mesh.triangles; }
/// Both sides: all triangles as they are, then all of them from behind.
inline std::vector<OuterFace> outer_faces(const SheetMesh& mesh) {
  std::vector<OuterFace> faces;
  for (Index e = 0; e < Index(mesh.triangles.size()); ++e) faces.push_back({mesh.triangles[e], e, false});
  for (Index e = 0; e < Index(mesh.triangles.size()); ++e) {
    const auto& t = mesh.triangles[e];
    faces.push_back({{t[0], t[2], t[1]}, e, true});
  }
  return faces;
}

/// The rectangle [0, width] × [0, height] (m) of the plane z = 0 in cells[0] × cells[1] cells of two
/// triangles each, turned to +z. Point (i, j) has number i + (cells[0] + 1) j.
inline SheetMesh sheet(double width, double height, const std::array<Index, 2>& cells, double thickness) {
  inner::check_grid("sheet", std::array{width, height}, cells);
  SheetMesh mesh{{}, {}, thickness};
  const Index row = cells[0] + 1;
  for (Index j = 0; j <= cells[1]; ++j)
    for (Index i = 0; i <= cells[0]; ++i)
      mesh.points.push_back({width * i / cells[0], height * j / cells[1], 0});
  for (Index j = 0; j < cells[1]; ++j)
    for (Index i = 0; i < cells[0]; ++i) {
      const Index p = i + row * j;
      mesh.triangles.push_back({p, p + 1, p + row + 1});
      mesh.triangles.push_back({p, p + row + 1, p + row});
    }
  return mesh;
}
/// A sheet of the triangles of a surface, as `read_obj` gives it.
inline SheetMesh sheet(const TriangleMesh& surface, double thickness) {
  return {{surface.vertices().begin(), surface.vertices().end()},
          {surface.triangles().begin(), surface.triangles().end()},
          thickness};
}

}  // namespace delassus
