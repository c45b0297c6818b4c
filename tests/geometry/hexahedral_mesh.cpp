#include <delassus/geometry/hexahedral_mesh.hpp>

#include <delassus/geometry/box_mesh.hpp>

#include <algorithm>
#include <string>

#include "catch.hpp"
#include "geometry/closed_surface.hpp"
#include "geometry/mesh_refusals.hpp"

using namespace delassus;

TEST_CASE("the hexahedra of a box fill it, and its surface closes around it") {
  HexahedralMesh mesh = hexahedral_box({2, 1, 3}, {4, 3, 5});
  check_mesh(mesh, "box");
  CHECK(mesh.points.size() == 5 * 4 * 6);
  CHECK(mesh.hexahedra.size() == 60);
  // Inner points moved: the faces are no longer plane, and the sum of the volumes is still the box's.
  for (std::size_t i = 0; i < mesh.points.size(); ++i) {
    Vec3& p = mesh.points[i];
    const Vec3 to = Vec3(2, 1, 3) - p;
    if (std::min(p.minCoeff(), to.minCoeff()) > 1e-9)
      p += 0.05 * Vec3(std::cos(3.0 * double(i)), std::cos(5.0 * double(i)), std::cos(7.0 * double(i)));
  }
  check_mesh(mesh, "box");
  double sum = 0, shares = 0;
  for (Index e = 0; e < 60; ++e) {
    sum += volume(mesh, e);
    for (int a = 0; a < 8; ++a) {
      const double share = inner::corner_share(mesh, e, a);
      CHECK(share > 0);
      shares += share;
    }
  }
  CHECK(std::abs(sum - 6) < 1e-13);  // 480 roundings of terms of 1/80
  CHECK(std::abs(shares - 6) < 1e-12);
  CHECK(surface(mesh).size() == 2 * 2 * (4 * 3 + 3 * 5 + 4 * 5));
  const Enclosed enclosed = enclosed_by_surface(mesh);
  CHECK(std::abs(enclosed.volume - 6) < 1e-13);
  CHECK(enclosed.area.norm() < 1e-13);
}

TEST_CASE("a hexahedron that is flat, folded, inside out or names no point is refused by its number") {
  HexahedralMesh mesh = hexahedral_box({1, 1, 1}, {2, 2, 1});
  auto& third = mesh.hexahedra[2];
  std::swap_ranges(third.begin(), third.begin() + 4, third.begin() + 4);
  CHECK(says(refusal(mesh), "hexahedron #2 is inside out"));
  CHECK(refusal(oriented(mesh)).empty());

  mesh = hexahedral_box({1, 1, 1}, {2, 2, 1});
  std::swap(mesh.hexahedra[3][1], mesh.hexahedra[3][2]);  // its bottom is a bow tie
  CHECK(says(refusal(mesh), "hexahedron #3 is"));
  mesh = hexahedral_box({1, 1, 1}, {1, 1, 1});
  mesh.points[7] = {0.2, 0.3, 0.3};  // one corner pushed through: the volume stays positive
  CHECK(volume(mesh, 0) > 0.1);
  CHECK(says(refusal(mesh), "hexahedron #0 is flat or folded at one of its corners"));

  CHECK(says(refusal(hexahedral_box({1, 1, 1e-10}, {1, 1, 1})), "hexahedron #0 is flat: its volume"));
  CHECK(refusal(hexahedral_box({1, 1, 1e-3}, {1, 1, 1})).empty());

  mesh = hexahedral_box({1, 1, 1}, {2, 1, 1});
  mesh.hexahedra[1][2] = 12;
  CHECK(says(refusal(mesh), "hexahedron #1 names point 12, but the mesh has points 0 to 11"));
  CHECK_THROWS_WITH(oriented(mesh), Catch::Contains("hexahedron #1 names point 12"));
  mesh = hexahedral_box({1, 1, 1}, {1, 1, 1});
  mesh.points.push_back({2, 2, 2});
  CHECK(says(refusal(mesh), "point #8 belongs to no hexahedron"));
  mesh.points[1][0] = std::numeric_limits<double>::quiet_NaN();
  CHECK(says(refusal(mesh), "point #1 of the mesh is not finite"));
  CHECK(says(refusal(HexahedralMesh{}), "has no hexahedron"));
  CHECK_THROWS_AS(hexahedral_box({1, 0, 1}, {1, 1, 1}), InvalidArgument);
}

TEST_CASE("hexahedra on the same side of a face are refused by their numbers, in whatever order of points") {
  HexahedralMesh mesh = hexahedral_box({1, 1, 1}, {1, 1, 1});
  const auto& h = mesh.hexahedra[0];
  mesh.hexahedra.push_back({h[1], h[2], h[3], h[0], h[5], h[6], h[7], h[4]});  // a quarter turn: the same
  CHECK(says(refusal(mesh), "hexahedra #0 and #1 lie on the same side of a face"));
  CHECK(refusal(hexahedral_box({1, 1, 1}, {3, 2, 2})).empty());
}
