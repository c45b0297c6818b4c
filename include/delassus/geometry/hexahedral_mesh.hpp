/// Hexahedral meshes: trilinear coordinates, checks, volumes, the outer surface.
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
#include <limits>
#include <string>
#include <utility>
#include <vector>

namespace delassus {

/// Points (m) and hexahedra of eight points each, in the order of Gmsh and VTK: four around the bottom,
/// counter-clockwise seen from the top, then the four above them.
struct HexahedralMesh {
  std::vector<Vec3> points;                     ///< m
  std::vector<std::array<Index, 8>> hexahedra;  ///< by numbers of points

  static constexpr const char* cell = "hexahedron";  ///< its word for an element in messages
  const auto& cells() const { return hexahedra; }  ///< by the name that all meshes share
  auto& cells() { return hexahedra; }  ///< the same, to change
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
  return jacobian_of(x, [&](int a) { return trilinear_slope(a, xi); });
}
inline double determinant(const Mat3& A) { return dot(Vec3(A.col(0)), cross(Vec3(A.col(1)), Vec3(A.col(2)))); }
/// Gauss's point g of the 2 × 2 × 2 rule, all of weight 1: exact up to the third power of each ξ.
inline Vec3 gauss_point(int g) {
  const double at = 1 / std::sqrt(3.0);
  return {at * hexahedron_corner[g][0], at * hexahedron_corner[g][1], at * hexahedron_corner[g][2]};
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

}  // namespace inner

/// Of hexahedron e, m³; negative where its points are ordered inside out.
inline double volume(const HexahedralMesh& mesh, Index e) {
  const inner::EightPoints x = inner::corners(mesh, e);
  double sum = 0;
  for (int g = 0; g < 8; ++g) sum += inner::determinant(inner::jacobian(x, inner::gauss_point(g)));
  return sum;
}

/// Where corner k is in the coordinates by which an element weighs its corners: ξ.
inline Vec3 place_of_corner(const HexahedralMesh&, int k) {
  const auto& s = inner::hexahedron_corner[k];
  return Vec3(s[0], s[1], s[2]);
}

/// The least of 8 det J at corners and Gauss's points, m³: of a box its volume. What
/// must stay above zero wherever the body is put.
inline double least_volume(const HexahedralMesh& mesh, Index e) {
  const inner::EightPoints x = inner::corners(mesh, e);
  double least = std::numeric_limits<double>::infinity();
  for (int a = 0; a < 8; ++a) {
    for (const Vec3& xi : {place_of_corner(mesh, a), inner::gauss_point(a)}) {
      const double d = 8 * inner::determinant(inner::jacobian(x, xi));
      if (!(d >= least)) least = d;
    }
  }
  return least;
}

/// Refuses a mesh that is no body: points that are not finite or in no hexahedron, and numbers of points that are
/// not there. Refuses hexahedra that are inside out, there twice, flat or folded: det J below 1e-9 of the size at
/// a corner or at a Gauss point.
inline void check_mesh(const HexahedralMesh& mesh, const std::string& who) {
  inner::check_points(mesh, who);
  for (Index e = 0; e < Index(mesh.hexahedra.size()); ++e) {
    const std::string name = inner::name_of_cell<HexahedralMesh>(who, e);
    const double V = volume(mesh, e), least = least_volume(mesh, e),
                 longest = inner::longest_edge(mesh, e), rounding = 1e-9 * longest * longest * longest;
    DELASSUS_EXPECT(std::abs(V) > rounding, name + " is flat: its volume is " + inner::text(V) +
                                                " m³, its longest diagonal " + inner::text(longest) + " m");
    DELASSUS_EXPECT(V > 0, name + " is inside out, its volume is " + inner::text(V) +
                               " m³; exchange its bottom and its top, as oriented(mesh) does");
    DELASSUS_EXPECT(least > rounding, name + " is flat or folded at one of its corners: 8 det ∂x/∂ξ is " +
                                          inner::text(least) +
                                          " m³ there; its points go around the bottom, then around the top");
  }
  inner::check_sides(mesh, inner::hexahedron_face, who, "hexahedra");
}

/// The same mesh with bottom and top exchanged in every hexahedron that is inside out.
inline HexahedralMesh oriented(HexahedralMesh mesh) {
  inner::check_corners(mesh, "oriented");
  for (Index e = 0; e < Index(mesh.hexahedra.size()); ++e)
    if (volume(mesh, e) < 0)
      for (int k = 0; k < 4; ++k) std::swap(mesh.hexahedra[e][k], mesh.hexahedra[e][k + 4]);
  return mesh;
}

/// The faces that belong to one hexahedron only, each as two triangles, in the order of the hexahedra.
inline std::vector<OuterFace> outer_faces(const HexahedralMesh& mesh) {
  std::vector<OuterFace> out;
  for (const auto& side : inner::outer_sides(mesh, inner::hexahedron_face)) {
    const auto& q = side.around;
    out.push_back({{q[0], q[1], q[2]}, side.element});
    out.push_back({{q[0], q[2], q[3]}, side.element});
  }
  return out;
}

}  // namespace delassus
