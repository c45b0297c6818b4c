/// Hexahedral meshes: trilinear coordinates, checks, volumes, the outer surface.
#pragma once

#include <delassus/core/expect.hpp>
#include <delassus/core/index.hpp>
#include <delassus/geometry/outer_face.hpp>
#include <delassus/math/linear.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <string>
#include <utility>
#include <vector>

namespace delassus {

/// Points (m) and hexahedra of eight points each, in the order of Gmsh and VTK: four around the bottom,
/// counter-clockwise seen from the top, then the four above them.
struct HexahedralMesh {
  std::vector<Vec3> points;
  std::vector<std::array<Index, 8>> hexahedra;

  static constexpr const char* cell = "hexahedron";
  const auto& cells() const { return hexahedra; }
  auto& cells() { return hexahedra; }
};

namespace inner {

using EightPoints = std::array<Vec3, 8>;

/// ξ of the corners.
inline constexpr int hexahedron_corner[8][3] = {{-1, -1, -1}, {1, -1, -1}, {1, 1, -1}, {-1, 1, -1},
                                                {-1, -1, 1},  {1, -1, 1},  {1, 1, 1},  {-1, 1, 1}};
/// The six faces, each seen from outside against the clock.
inline constexpr int hexahedron_face[6][4] = {{0, 3, 2, 1}, {4, 5, 6, 7}, {0, 1, 5, 4},
                                              {2, 3, 7, 6}, {1, 2, 6, 5}, {3, 0, 4, 7}};

/// N_a(ξ) = ⅛ Π_i (1 + ξ_ai ξ_i), ξ ∈ [−1, 1]³.
inline double trilinear(int a, const Vec3& xi) {
  double product = 0.125;
  for (int i = 0; i < 3; ++i) product *= 1 + hexahedron_corner[a][i] * xi[i];
  return product;
}
/// ∂N_a/∂ξ.
inline Vec3 trilinear_slope(int a, const Vec3& xi) {
  const auto& s = hexahedron_corner[a];
  const double x = 1 + s[0] * xi[0], y = 1 + s[1] * xi[1], z = 1 + s[2] * xi[2];
  return {0.125 * s[0] * y * z, 0.125 * s[1] * z * x, 0.125 * s[2] * x * y};
}
/// J = ∂x/∂ξ.
inline Mat3 jacobian(const EightPoints& x, const Vec3& xi) {
  Mat3 J = Mat3::Zero();
  for (int a = 0; a < 8; ++a) {
    const Vec3 slope = trilinear_slope(a, xi);
    for (int k = 0; k < 3; ++k)
      for (int i = 0; i < 3; ++i) J(i, k) += x[a][i] * slope[k];
  }
  return J;
}
inline double determinant(const Mat3& A) { return Vec3(A.col(0)).dot(Vec3(A.col(1)).cross(Vec3(A.col(2)))); }
/// Gauss's point g of the 2 × 2 × 2 rule, all of weight 1: exact up to the third power of each ξ.
inline Vec3 gauss_point(int g) {
  const double at = 1 / std::sqrt(3.0);
  return {at * hexahedron_corner[g][0], at * hexahedron_corner[g][1], at * hexahedron_corner[g][2]};
}

inline EightPoints corners(const HexahedralMesh& mesh, Index e) {
  EightPoints x;
  for (int a = 0; a < 8; ++a) x[a] = mesh.points[mesh.hexahedra[e][a]];
  return x;
}

/// The least of 8 det J at corners and Gauss's points, m³: of a box its volume.
inline double least_determinant(const HexahedralMesh& mesh, Index e) {
  const EightPoints x = corners(mesh, e);
  double least = std::numeric_limits<double>::infinity();
  for (int a = 0; a < 8; ++a) {
    const Vec3 corner(hexahedron_corner[a][0], hexahedron_corner[a][1], hexahedron_corner[a][2]);
    for (const Vec3& xi : {corner, gauss_point(a)}) {
      const double d = 8 * determinant(jacobian(x, xi));
      if (!(d >= least)) least = d;
    }
  }
  return least;
}

/// ∫ N_a dV over hexahedron e, m³.
inline double corner_share(const HexahedralMesh& mesh, Index e, int a) {
  const EightPoints x = corners(mesh, e);
  double sum = 0;
  for (int g = 0; g < 8; ++g) {
    const Vec3 xi = gauss_point(g);
    sum += trilinear(a, xi) * determinant(jacobian(x, xi));
  }
  return sum;
}

inline double longest_edge(const HexahedralMesh& mesh, Index e) {
  const EightPoints x = corners(mesh, e);
  double longest = 0;
  for (int a = 0; a < 8; ++a)
    for (int b = a + 1; b < 8; ++b) longest = std::max(longest, (x[a] - x[b]).norm());
  return longest;
}

/// Refuses hexahedra that name points which are not there.
inline void check_corners(const HexahedralMesh& mesh, const std::string& who) {
  const Index count = Index(mesh.points.size());
  for (Index e = 0; e < Index(mesh.hexahedra.size()); ++e)
    for (const Index i : mesh.hexahedra[e])
      DELASSUS_EXPECT(i >= 0 && i < count, who + ": hexahedron #" + std::to_string(e) + " names point " +
                                               std::to_string(i) + ", but the mesh has points 0 to " +
                                               std::to_string(count - 1));
}

/// A face of a hexahedron: its points as they lie around it, and sorted with the way around as a fifth
/// number.
struct HexahedronSide {
  std::array<Index, 4> around;
  std::array<Index, 5> face;
  Index number;  ///< 6 e + which of its faces

  HexahedronSide(const std::array<Index, 8>& h, Index e, int which) : number(6 * e + which) {
    for (int k = 0; k < 4; ++k) around[k] = face[k] = h[hexahedron_face[which][k]];
    const auto least = std::min_element(around.begin(), around.end()) - around.begin();
    face[4] = around[(least + 1) % 4] < around[(least + 3) % 4] ? 0 : 1;
    std::sort(face.begin(), face.begin() + 4);
  }
  bool has_points_of(const HexahedronSide& other) const {
    return std::equal(face.begin(), face.begin() + 4, other.face.begin());
  }
};

/// All faces, those of the same points beside each other.
inline std::vector<HexahedronSide> sorted_sides(const HexahedralMesh& mesh) {
  std::vector<HexahedronSide> sides;
  sides.reserve(6 * mesh.hexahedra.size());
  for (Index e = 0; e < Index(mesh.hexahedra.size()); ++e)
    for (int k = 0; k < 6; ++k) sides.emplace_back(mesh.hexahedra[e], e, k);
  std::sort(sides.begin(), sides.end(), [](const HexahedronSide& a, const HexahedronSide& b) {
    return a.face != b.face ? a.face < b.face : a.number < b.number;
  });
  return sides;
}

/// Refuses hexahedra that lie on the same side of a face, as one that is named twice does.
inline void check_sides(const HexahedralMesh& mesh, const std::string& who) {
  const auto sides = sorted_sides(mesh);
  for (std::size_t k = 1; k < sides.size(); ++k)
    DELASSUS_EXPECT(sides[k - 1].face != sides[k].face,
                    who + ": hexahedra #" + std::to_string(sides[k - 1].number / 6) + " and #" +
                        std::to_string(sides[k].number / 6) +
                        " lie on the same side of a face; name each once");
}

}  // namespace inner

/// Of hexahedron e, m³; negative where its points are ordered inside out.
inline double volume(const HexahedralMesh& mesh, Index e) {
  const inner::EightPoints x = inner::corners(mesh, e);
  double sum = 0;
  for (int g = 0; g < 8; ++g) sum += inner::determinant(inner::jacobian(x, inner::gauss_point(g)));
  return sum;
}

/// Refuses a mesh that is no body: points that are not finite or in no hexahedron, numbers of points that are
/// not there, hexahedra that are flat or folded (det J below 1e-9 of the size at a corner or at a Gauss
/// point), inside out or there twice.
inline void check_mesh(const HexahedralMesh& mesh, const std::string& who) {
  const Index count = Index(mesh.points.size());
  DELASSUS_EXPECT(!mesh.hexahedra.empty(), who + ": the mesh has no hexahedron");
  for (Index i = 0; i < count; ++i)
    DELASSUS_EXPECT(is_finite(mesh.points[i]),
                    who + ": point #" + std::to_string(i) + " of the mesh is not finite");
  inner::check_corners(mesh, who);
  std::vector<char> is_used(count, 0);
  for (Index e = 0; e < Index(mesh.hexahedra.size()); ++e) {
    const std::string name = who + ": hexahedron #" + std::to_string(e);
    for (const Index i : mesh.hexahedra[e]) is_used[i] = 1;
    const double V = volume(mesh, e), least = inner::least_determinant(mesh, e),
                 longest = inner::longest_edge(mesh, e), rounding = 1e-9 * longest * longest * longest;
    DELASSUS_EXPECT(std::abs(V) > rounding, name + " is flat: its volume is " + inner::text(V) +
                                                " m³, its longest diagonal " + inner::text(longest) + " m");
    DELASSUS_EXPECT(V > 0, name + " is inside out, its volume is " + inner::text(V) +
                               " m³; exchange its bottom and its top, as oriented(mesh) does");
    DELASSUS_EXPECT(least > rounding, name + " is flat or folded at one of its corners: 8 det ∂x/∂ξ is " +
                                          inner::text(least) +
                                          " m³ there; its points go around the bottom, then around the top");
  }
  inner::check_sides(mesh, who);
  for (Index i = 0; i < count; ++i)
    DELASSUS_EXPECT(is_used[i], who + ": point #" + std::to_string(i) +
                                    " belongs to no hexahedron; take it out of the mesh");
}

/// The same mesh with bottom and top exchanged in every hexahedron that is inside out.
inline HexahedralMesh oriented(HexahedralMesh mesh) {
  inner::check_corners(mesh, "oriented");
  for (Index e = 0; e < Index(mesh.hexahedra.size()); ++e)
    if (volume(mesh, e) < 0)
      for (int k = 0; k < 4; ++k) std::swap(mesh.hexahedra[e][k], mesh.hexahedra[e][k + 4]);
  return mesh;
}

/// Where corner k is in the coordinates by which an element weighs its corners: ξ.
inline Vec3 place_of_corner(const HexahedralMesh&, int k) {
  const auto& s = inner::hexahedron_corner[k];
  return Vec3(s[0], s[1], s[2]);
}

/// The faces that belong to one hexahedron only, each as two triangles, in the order of the hexahedra.
inline std::vector<OuterFace> outer_faces(const HexahedralMesh& mesh) {
  const auto sides = inner::sorted_sides(mesh);
  std::vector<inner::HexahedronSide> outer;
  for (std::size_t k = 0, next = 0; k < sides.size(); k = next) {
    for (next = k; next < sides.size() && sides[next].has_points_of(sides[k]);) ++next;
    if (next == k + 1) outer.push_back(sides[k]);
  }
  std::sort(outer.begin(), outer.end(), [](const auto& a, const auto& b) { return a.number < b.number; });
  std::vector<OuterFace> out;
  for (const auto& [q, face, number] : outer) {
    out.push_back({{q[0], q[1], q[2]}, number / 6});
    out.push_back({{q[0], q[2], q[3]}, number / 6});
  }
  return out;
}

/// The triangles of `outer_faces`.
inline std::vector<std::array<Index, 3>> surface(const HexahedralMesh& mesh) {
  return triangles_of(outer_faces(mesh));
}

/// What must stay above zero wherever the body is put, m³.
inline double least_volume(const HexahedralMesh& mesh, Index e) { return inner::least_determinant(mesh, e); }

}  // namespace delassus
