#include <delassus/geometry/quadratic_tetrahedral_mesh.hpp>

#include <delassus/geometry/box_mesh.hpp>

#include <algorithm>
#include <string>

#include "catch.hpp"
#include "geometry/closed_surface.hpp"
#include "geometry/mesh_refusals.hpp"

namespace quadratic_tetrahedral_mesh_tests {

using namespace delassus;

TEST_CASE("quadratic shape functions are one at their node, zero at the others, and their slopes fit") {
  const QuadraticTetrahedralMesh mesh = quadratic(box_mesh({1, 1, 1}, {1, 1, 1}));
  for (int k = 0; k < 10; ++k)
    for (int a = 0; a < 10; ++a)
      CHECK(std::abs(inner::quadratic(a, place_of_corner(mesh, k)) - (a == k ? 1 : 0)) < 1e-15);
  const Vec3 xi(0.2, 0.3, 0.1);
  const double h = 1e-4;  // differences of quadratic functions are exact but for ε/h
  for (int a = 0; a < 10; ++a)
    for (int k = 0; k < 3; ++k) {
      const Vec3 step = h * unit_axis(k);
      const double slope =
          (inner::quadratic(a, Vec3(xi + step)) - inner::quadratic(a, Vec3(xi - step))) / (2 * h);
      CHECK(std::abs(inner::quadratic_slope(a, xi)[k] - slope) < 1e-11);
    }
}

TEST_CASE(
    "tetrahedra with nodes on their edges fill a box, bent edges inside or not, and their surface closes") {
  QuadraticTetrahedralMesh mesh = quadratic(box_mesh({2, 1, 3}, {4, 2, 3}));
  check_mesh(mesh, "box");
  CHECK(mesh.tetrahedra.size() == 6 * 24);
  // The nodes of a grid with twice the cells: every edge of a Kuhn cell has its middle on it.
  CHECK(mesh.points.size() == 9 * 5 * 7);
  for (std::size_t i = 0; i < mesh.points.size(); ++i) {
    Vec3& p = mesh.points[i];
    const Vec3 to = Vec3(2, 1, 3) - p;
    if (std::min(p.minCoeff(), to.minCoeff()) > 1e-9)
      p += 0.03 * Vec3(std::cos(3.0 * double(i)), std::cos(5.0 * double(i)), std::cos(7.0 * double(i)));
  }
  check_mesh(mesh, "box");
  double sum = 0;
  for (Index e = 0; e < Index(mesh.tetrahedra.size()); ++e) {
    sum += volume(mesh, e);
    CHECK(least_volume(mesh, e) > 0);
  }
  CHECK(std::abs(sum - 6) < 1e-13);  // some hundred roundings of terms of 1/24
  CHECK(surface(mesh).size() == 4 * 2 * 2 * (4 * 2 + 2 * 3 + 4 * 3));
  const Enclosed enclosed = enclosed_by_surface(mesh);
  CHECK(std::abs(enclosed.volume - 6) < 1e-13);
  CHECK(enclosed.area.norm() < 1e-13);
}

TEST_CASE("a ten-node tetrahedron that is inside out is turned round, its edges' nodes with it") {
  QuadraticTetrahedralMesh mesh = quadratic(box_mesh({1, 1, 1}, {1, 1, 1}));
  auto& t = mesh.tetrahedra[2];
  std::swap(t[2], t[3]), std::swap(t[5], t[8]), std::swap(t[6], t[7]);
  CHECK(says(refusal(mesh), "tetrahedron #2 is inside out"));
  mesh = oriented(mesh);
  CHECK(refusal(mesh).empty());
  CHECK(std::abs(volume(mesh, 2) - 1. / 6) < 1e-15);
}

TEST_CASE("ten-node tetrahedra that are no body are refused by their number") {
  const QuadraticTetrahedralMesh sound = quadratic(box_mesh({1, 1, 1}, {1, 1, 1}));
  CHECK(refusal(sound).empty());
  CHECK(says(refusal(QuadraticTetrahedralMesh{}), "no tetrahedron"));
  auto mesh = sound;
  mesh.tetrahedra[1][7] = 99;
  CHECK(says(refusal(mesh), "tetrahedron #1 names point 99"));
  mesh = sound;
  mesh.points.push_back({0, 0, 0});
  CHECK(says(refusal(mesh), "point #27 belongs to no tetrahedron"));
  mesh = sound;
  std::swap(mesh.tetrahedra[3][4], mesh.tetrahedra[3][9]);  // as with the nodes in another order
  CHECK(says(refusal(mesh), "tetrahedron #3 is folded"));
  mesh = sound;
  mesh.points[0][0] = std::nan("");
  CHECK(says(refusal(mesh), "point #0 of the mesh is not finite"));
  mesh = sound;
  mesh.tetrahedra.push_back(mesh.tetrahedra[0]);
  CHECK(says(refusal(mesh), "tetrahedra #0 and #6 lie on the same side"));
  mesh = sound;  // a node of its own on an edge: the body would be torn there
  mesh.points.push_back(mesh.points[mesh.tetrahedra[4][4]]);
  mesh.tetrahedra[4][4] = 27;
  CHECK(says(refusal(mesh), "different nodes on the edge"));
}

}  // namespace quadratic_tetrahedral_mesh_tests
