/// Tetrahedral meshes: checks, volumes, the outer surface.
#pragma once

#include <delassus/core/expect.hpp>
#include <delassus/core/index.hpp>
#include <delassus/geometry/outer_face.hpp>
#include <delassus/math/linear.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <string>
#include <utility>
#include <vector>

namespace delassus {

/// Points (m) and tetrahedra of four points each, ordered so that (x₁ − x₀) · ((x₂ − x₀) × (x₃ − x₀)) > 0.
struct TetrahedralMesh {
  std::vector<Vec3> points;
  std::vector<std::array<Index, 4>> tetrahedra;

  static constexpr const char* cell = "tetrahedron";
  static constexpr bool has_shares = true;  ///< places in an element are the shares of its corners 1, 2, 3
  const auto& cells() const { return tetrahedra; }
  auto& cells() { return tetrahedra; }
};

/// Of tetrahedron e, m³; negative where its points are ordered inside out.
inline double volume(const TetrahedralMesh& mesh, Index e) {
  const auto& t = mesh.tetrahedra[e];
  const Vec3 &o = mesh.points[t[0]], a = mesh.points[t[1]] - o, b = mesh.points[t[2]] - o,
             c = mesh.points[t[3]] - o;
  return a.dot(b.cross(c)) / 6;
}

namespace inner {

inline double longest_edge(const TetrahedralMesh& mesh, Index e) {
  const auto& t = mesh.tetrahedra[e];
  double longest = 0;
  for (int a = 0; a < 4; ++a)
    for (int b = a + 1; b < 4; ++b)
      longest = std::max(longest, (mesh.points[t[a]] - mesh.points[t[b]]).norm());
  return longest;
}

/// Refuses tetrahedra that name points which are not there.
inline void check_corners(const TetrahedralMesh& mesh, const std::string& who) {
  const Index count = Index(mesh.points.size());
  for (Index e = 0; e < Index(mesh.tetrahedra.size()); ++e)
    for (const Index i : mesh.tetrahedra[e])
      DELASSUS_EXPECT(i >= 0 && i < count, who + ": tetrahedron #" + std::to_string(e) + " names point " +
                                               std::to_string(i) + ", but the mesh has points 0 to " +
                                               std::to_string(count - 1));
}

/// The four faces of a tetrahedron, each seen from outside against the clock.
inline constexpr int tetrahedron_face[4][3] = {{1, 2, 3}, {0, 3, 2}, {0, 1, 3}, {0, 2, 1}};

/// Refuses tetrahedra that lie on the same side of a face, as one that is named twice does.
inline void check_sides(const TetrahedralMesh& mesh, const std::string& who) {
  struct Side {
    std::array<Index, 4> face;  ///< its points, sorted, and whether that was an even permutation
    Index tetrahedron;
  };
  std::vector<Side> sides;
  sides.reserve(4 * mesh.tetrahedra.size());
  for (Index e = 0; e < Index(mesh.tetrahedra.size()); ++e)
    for (const auto& [i, j, k] : tetrahedron_face) {
      const auto& t = mesh.tetrahedra[e];
      const int swaps = (t[i] > t[j]) + (t[i] > t[k]) + (t[j] > t[k]);
      Side& side = sides.emplace_back(Side{{t[i], t[j], t[k], swaps % 2}, e});
      std::sort(side.face.begin(), side.face.begin() + 3);
    }
  std::sort(sides.begin(), sides.end(), [](const Side& a, const Side& b) {
    return a.face != b.face ? a.face < b.face : a.tetrahedron < b.tetrahedron;
  });
  const auto found = std::adjacent_find(sides.begin(), sides.end(),
                                        [](const Side& a, const Side& b) { return a.face == b.face; });
  if (found == sides.end()) return;
  refuse(who + ": tetrahedra #" + std::to_string(found->tetrahedron) + " and #" +
         std::to_string((found + 1)->tetrahedron) + " lie on the same side of a face; name each once");
}

}  // namespace inner

/// Refuses a mesh that is no body: points that are not finite or in no tetrahedron, numbers of points that
/// are not there, tetrahedra that are flat (height below 1e-9 of the size), inside out or there twice.
inline void check_mesh(const TetrahedralMesh& mesh, const std::string& who) {
  const Index count = Index(mesh.points.size());
  DELASSUS_EXPECT(!mesh.tetrahedra.empty(), who + ": the mesh has no tetrahedron");
  for (Index i = 0; i < count; ++i)
    DELASSUS_EXPECT(is_finite(mesh.points[i]),
                    who + ": point #" + std::to_string(i) + " of the mesh is not finite");
  inner::check_corners(mesh, who);
  std::vector<char> is_used(count, 0);
  for (Index e = 0; e < Index(mesh.tetrahedra.size()); ++e) {
    const std::string name = who + ": tetrahedron #" + std::to_string(e);
    for (const Index i : mesh.tetrahedra[e]) is_used[i] = 1;
    const double V = volume(mesh, e), longest = inner::longest_edge(mesh, e);
    DELASSUS_EXPECT(std::abs(6 * V) > 1e-9 * longest * longest * longest,
                    name + " is flat: its volume is " + inner::text(V) + " m³, its longest edge " +
                        inner::text(longest) + " m");
    DELASSUS_EXPECT(V > 0, name + " is inside out, its volume is " + inner::text(V) +
                               " m³; exchange two of its points, as oriented(mesh) does");
  }
  inner::check_sides(mesh, who);
  for (Index i = 0; i < count; ++i)
    DELASSUS_EXPECT(is_used[i], who + ": point #" + std::to_string(i) +
                                    " belongs to no tetrahedron; take it out of the mesh");
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
  return k > 0 ? unit_axis(k - 1) : Vec3(Vec3::Zero());
}

/// The triangles that belong to one tetrahedron only, in the order of the tetrahedra.
inline std::vector<OuterFace> outer_faces(const TetrahedralMesh& mesh) {
  struct Side {
    std::array<Index, 3> sorted, triangle;
    std::size_t number;
  };
  std::vector<Side> faces;
  for (const auto& t : mesh.tetrahedra)
    for (const auto& [a, b, c] : inner::tetrahedron_face) {
      Side face{{t[a], t[b], t[c]}, {t[a], t[b], t[c]}, faces.size()};
      std::sort(face.sorted.begin(), face.sorted.end());
      faces.push_back(face);
    }
  const auto by_points = [](const Side& a, const Side& b) {
    return a.sorted != b.sorted ? a.sorted < b.sorted : a.number < b.number;
  };
  std::sort(faces.begin(), faces.end(), by_points);
  std::vector<Side> outer;
  for (std::size_t k = 0, next = 0; k < faces.size(); k = next) {
    for (next = k; next < faces.size() && faces[next].sorted == faces[k].sorted;) ++next;
    if (next == k + 1) outer.push_back(faces[k]);
  }
  std::sort(outer.begin(), outer.end(), [](const Side& a, const Side& b) { return a.number < b.number; });
  std::vector<OuterFace> out;
  for (const Side& face : outer) out.push_back({face.triangle, Index(face.number / 4)});
  return out;
}

/// The triangles of `outer_faces`.
inline std::vector<std::array<Index, 3>> surface(const TetrahedralMesh& mesh) {
  return triangles_of(outer_faces(mesh));
}

}  // namespace delassus
