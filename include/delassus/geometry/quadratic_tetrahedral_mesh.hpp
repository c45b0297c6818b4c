/// Meshes of tetrahedra with a node on each edge: shape functions, checks, volumes, the outer surface.
#pragma once

#include <delassus/core/sort.hpp>
#include <delassus/geometry/hexahedral_mesh.hpp>
#include <delassus/geometry/tetrahedral_mesh.hpp>

#include <algorithm>
#include <array>
#include <limits>
#include <string>
#include <utility>
#include <vector>

namespace delassus {

/// Points (m) and tetrahedra of ten points each, in the order of VTK. Four corners as those of a `TetrahedralMesh`
/// come first. The nodes on the edges (0, 1), (1, 2), (0, 2), (0, 3), (1, 3), (2, 3) follow. Edges may be bent.
struct QuadraticTetrahedralMesh {
  std::vector<Vec3> points;                       ///< m
  std::vector<std::array<Index, 10>> tetrahedra;  ///< by numbers of points

  static constexpr const char* cell = "tetrahedron";  ///< its word for an element in messages
  static constexpr bool has_shares = true;  ///< places in an element are the shares of its corners 1, 2, 3
  const auto& cells() const { return tetrahedra; }  ///< by the name that all meshes share
  auto& cells() { return tetrahedra; }  ///< the same, to change
};

namespace inner {

using TenPoints = std::array<Vec3, 10>;

inline constexpr int tetrahedron_edge[6][2] = {{0, 1}, {1, 2}, {0, 2}, {0, 3}, {1, 3}, {2, 3}};
/// The six nodes of each face: its corners, seen from outside against the clock, then the node after each.
inline constexpr int quadratic_face[4][6] = {
    {1, 2, 3, 5, 9, 8}, {0, 3, 2, 7, 9, 6}, {0, 1, 3, 4, 8, 7}, {0, 2, 1, 6, 5, 4}};

/// The share w_k of corner k, which is linear; ξ holds those of 1, 2, 3.
inline double corner_weight(int k, const Vec3& xi) { return k == 0 ? 1 - xi[0] - xi[1] - xi[2] : xi[k - 1]; }
inline Vec3 corner_weight_slope(int k) { return k == 0 ? Vec3(-1, -1, -1) : unit_axis(k - 1); }
/// N_a(ξ): w (2 w − 1) of a corner, 4 w_i w_j of an edge.
inline double quadratic(int a, const Vec3& xi) {
  if (a < 4) return corner_weight(a, xi) * (2 * corner_weight(a, xi) - 1);
  const auto& [i, j] = tetrahedron_edge[a - 4];
  return 4 * corner_weight(i, xi) * corner_weight(j, xi);
}
/// ∂N_a/∂ξ.
inline Vec3 quadratic_slope(int a, const Vec3& xi) {
  if (a < 4) return (4 * corner_weight(a, xi) - 1) * corner_weight_slope(a);
  const auto& [i, j] = tetrahedron_edge[a - 4];
  return 4 * (corner_weight(i, xi) * corner_weight_slope(j) + corner_weight(j, xi) * corner_weight_slope(i));
}
/// J = ∂x/∂ξ.
inline Mat3 jacobian(const TenPoints& x, const Vec3& xi) {
  return jacobian_of(x, [&](int a) { return quadratic_slope(a, xi); });
}
/// Point g of the rule of four points, each of weight 1/24: exact up to the second power.
inline Vec3 tetrahedron_point(int g) {
  const double near = 0.5854101966249685, far = 0.1381966011250105;  // (5 + 3√5)/20, (5 − √5)/20
  Vec3 xi(far, far, far);
  if (g > 0) xi[g - 1] = near;
  return xi;
}

/// f(ξ, weight) of the rule of five points, one weight negative, that is exact up to the third power: for
/// volumes, not for materials.
void each_exact_point(auto&& f) {
  f(Vec3(0.25, 0.25, 0.25), -2. / 15);
  for (int g = 0; g < 4; ++g) {
    Vec3 xi(1. / 6, 1. / 6, 1. / 6);
    if (g > 0) xi[g - 1] = 0.5;
    f(xi, 3. / 40);
  }
}

/// The tetrahedra of the corners alone, over the same points.
inline TetrahedralMesh straight(const QuadraticTetrahedralMesh& mesh) {
  TetrahedralMesh out{mesh.points, {}};
  for (const auto& t : mesh.tetrahedra) out.tetrahedra.push_back({t[0], t[1], t[2], t[3]});
  return out;
}

}  // namespace inner

/// Where node k is in the coordinates by which an element weighs its nodes: the shares of corners 1, 2, 3.
inline Vec3 place_of_corner(const QuadraticTetrahedralMesh&, int k) {
  Vec3 xi;
  for (int i = 0; i < 3; ++i)
    xi[i] = k < 4 ? k == i + 1
                  : 0.5 * (inner::tetrahedron_edge[k - 4][0] == i + 1 ||
                           inner::tetrahedron_edge[k - 4][1] == i + 1);
  return xi;
}

/// Of tetrahedron e, m³; negative where it is inside out.
inline double volume(const QuadraticTetrahedralMesh& mesh, Index e) {
  const inner::TenPoints x = inner::corners(mesh, e);
  double sum = 0;
  inner::each_exact_point(
      [&](const Vec3& xi, double weight) { sum += weight * inner::determinant(inner::jacobian(x, xi)); });
  return sum;
}

/// The least of det J/6 at the nodes and at the points of the rule, m³: of straight edges the volume. What
/// must stay above zero wherever the body is put.
inline double least_volume(const QuadraticTetrahedralMesh& mesh, Index e) {
  const inner::TenPoints x = inner::corners(mesh, e);
  double least = std::numeric_limits<double>::infinity();
  for (int k = 0; k < 14; ++k) {
    const Vec3 xi = k < 10 ? place_of_corner(mesh, k) : inner::tetrahedron_point(k - 10);
    const double d = inner::determinant(inner::jacobian(x, xi)) / 6;
    if (!(d >= least)) least = d;
  }
  return least;
}

/// Refuses a mesh that is no body: what `check_mesh` refuses of the tetrahedra of its corners, and points on edges
/// that are not there or belong to nothing. Refuses edges so bent that an element folds, and an edge with two
/// nodes.
inline void check_mesh(const QuadraticTetrahedralMesh& mesh, const std::string& who) {
  inner::check_points(mesh, who);
  std::vector<std::array<Index, 4>> edges;  ///< its corners, its node, its element
  const TetrahedralMesh straight = inner::straight(mesh);
  for (Index e = 0; e < Index(mesh.tetrahedra.size()); ++e) {
    const auto& t = mesh.tetrahedra[e];
    const std::string name = inner::name_of_cell<QuadraticTetrahedralMesh>(who, e);
    for (int k = 0; k < 6; ++k) {
      const auto [a, b] = std::minmax(t[inner::tetrahedron_edge[k][0]], t[inner::tetrahedron_edge[k][1]]);
      edges.push_back({a, b, t[4 + k], e});
    }
    const double V = volume(straight, e), longest = inner::longest_edge(straight, e),
                 rounding = 1e-9 * longest * longest * longest, least = least_volume(mesh, e);
    DELASSUS_EXPECT(std::abs(6 * V) > rounding, name + " is flat: the volume between its corners is " +
                                                    inner::text(V) + " m³, its longest edge " +
                                                    inner::text(longest) + " m");
    DELASSUS_EXPECT(V > 0,
                    name + " is inside out, the volume between its corners is " + inner::text(V) +
                        " m³; exchange two of them and the nodes of their edges, as oriented(mesh) does");
    DELASSUS_EXPECT(6 * least > rounding, name + " is folded by its bent edges: det ∂x/∂ξ is " +
                                              inner::text(6 * least) +
                                              " m³ somewhere; move the nodes of its edges to their middles");
  }
  inner::check_sides(straight, inner::tetrahedron_face, who, "tetrahedra");
  inner::sort(edges);
  for (std::size_t k = 1; k < edges.size(); ++k)
    DELASSUS_EXPECT(
        edges[k][0] != edges[k - 1][0] || edges[k][1] != edges[k - 1][1] || edges[k][2] == edges[k - 1][2],
        who + ": tetrahedra #" + std::to_string(edges[k - 1][3]) + " and #" + std::to_string(edges[k][3]) +
            " have different nodes on the edge between points " + std::to_string(edges[k][0]) + " and " +
            std::to_string(edges[k][1]) + "; name one of them in both");
}

/// The same mesh with two corners exchanged, and the nodes of their edges, in every tetrahedron that is
/// inside out.
inline QuadraticTetrahedralMesh oriented(QuadraticTetrahedralMesh mesh) {
  const TetrahedralMesh straight = inner::straight(mesh);
  inner::check_corners(straight, "oriented");
  for (Index e = 0; e < Index(mesh.tetrahedra.size()); ++e) {
    if (volume(straight, e) >= 0) continue;
    auto& t = mesh.tetrahedra[e];
    std::swap(t[2], t[3]), std::swap(t[5], t[8]), std::swap(t[6], t[7]);
  }
  return mesh;
}

/// The same tetrahedra with a node in the middle of each edge, after the points there are.
inline QuadraticTetrahedralMesh quadratic(const TetrahedralMesh& mesh) {
  inner::check_corners(mesh, "quadratic");
  std::vector<std::pair<Index, Index>> edges;
  const auto edge = [](const std::array<Index, 4>& t, int k) -> std::pair<Index, Index> {
    return std::minmax(t[inner::tetrahedron_edge[k][0]], t[inner::tetrahedron_edge[k][1]]);
  };
  for (const auto& t : mesh.tetrahedra)
    for (int k = 0; k < 6; ++k) edges.push_back(edge(t, k));
  inner::sort(edges);
  inner::drop_repeats(edges);
  QuadraticTetrahedralMesh out{mesh.points, {}};
  for (const auto& [a, b] : edges) out.points.push_back(0.5 * (mesh.points[a] + mesh.points[b]));
  for (const auto& t : mesh.tetrahedra) {
    auto& ten = out.tetrahedra.emplace_back();
    std::copy(t.begin(), t.end(), ten.begin());
    for (int k = 0; k < 6; ++k)
      ten[4 + k] = Index(mesh.points.size()) +
                   Index(inner::lower_bound(edges.data(), edges.data() + edges.size(), edge(t, k)) - edges.data());
  }
  return out;
}

/// The faces that belong to one tetrahedron only, each as the four triangles between its six nodes, in the
/// order of the tetrahedra.
inline std::vector<OuterFace> outer_faces(const QuadraticTetrahedralMesh& mesh) {
  std::vector<OuterFace> out;
  for (const auto& side : inner::outer_sides(mesh, inner::quadratic_face)) {
    const auto& [a, b, c, ab, bc, ca] = side.around;
    for (const auto& triangle : {std::array<Index, 3>{a, ab, ca}, {ab, b, bc}, {ca, bc, c}, {ab, bc, ca}})
      out.push_back({triangle, side.element});
  }
  return out;
}

}  // namespace delassus
