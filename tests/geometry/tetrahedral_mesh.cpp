#include <delassus/geometry/tetrahedral_mesh.hpp>

#include <delassus/geometry/box_mesh.hpp>

#include <algorithm>
#include <set>
#include <string>

#include "catch.hpp"
#include "geometry/closed_surface.hpp"
#include "geometry/mesh_refusals.hpp"

using namespace delassus;

namespace {

TetrahedralMesh one_tetrahedron() { return {{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}}, {{0, 1, 2, 3}}}; }

}  // namespace

TEST_CASE("the tetrahedra of a box fill it, and its surface closes around it, with five or six a cell") {
  for (const CellSplit split : {CellSplit::five, CellSplit::six}) {
    const TetrahedralMesh mesh = box_mesh({2, 1, 3}, {4, 3, 5}, split);
    check_mesh(mesh, "box");
    CHECK(mesh.points.size() == 5 * 4 * 6);
    CHECK(mesh.tetrahedra.size() == (split == CellSplit::five ? 5 : 6) * 60);
    double sum = 0;
    for (Index e = 0; e < Index(mesh.tetrahedra.size()); ++e) sum += volume(mesh, e);
    CHECK(std::abs(sum - 6) < 1e-13);  // 360 roundings of terms of 1/60
    CHECK(surface(mesh).size() == 2 * 2 * (4 * 3 + 3 * 5 + 4 * 5));
    const Enclosed enclosed = enclosed_by_surface(mesh);
    CHECK(std::abs(enclosed.volume - 6) < 1e-13);
    CHECK(enclosed.area.norm() < 1e-13);
  }
}

TEST_CASE("neighbours in a box share whole faces, with five or six tetrahedra a cell") {
  for (const CellSplit split : {CellSplit::five, CellSplit::six}) {
    const TetrahedralMesh mesh = box_mesh({1, 1, 1}, {3, 3, 3}, split);
    std::multiset<std::array<Index, 3>> faces;
    for (const auto& t : mesh.tetrahedra)
      for (int skip = 0; skip < 4; ++skip) {
        std::array<Index, 3> face;
        for (int a = 0, k = 0; a < 4; ++a)
          if (a != skip) face[k++] = t[a];
        std::sort(face.begin(), face.end());
        faces.insert(face);
      }
    // A face of one tetrahedron only lies in a side of the box: its three points share a coordinate that is 0
    // or 1.
    for (const auto& f : faces) {
      REQUIRE(faces.count(f) <= 2);
      if (faces.count(f) == 2) continue;
      bool is_outside = false;
      for (int k = 0; k < 3; ++k)
        for (const double side : {0.0, 1.0})
          is_outside = is_outside ||
                       std::all_of(f.begin(), f.end(), [&](Index i) { return mesh.points[i][k] == side; });
      REQUIRE(is_outside);
    }
  }
}

TEST_CASE("tetrahedra on the same side of a face are refused by their numbers, in whatever order of points") {
  TetrahedralMesh mesh = one_tetrahedron();
  mesh.tetrahedra.push_back({2, 0, 1, 3});  // even permutation: the same, as seen from all sides
  CHECK(refusal(mesh).find("tetrahedra #0 and #1 lie on the same side") != std::string::npos);
  mesh = one_tetrahedron();
  mesh.points.push_back({0.2, 0.2, 0.2});  // within it
  mesh.tetrahedra.push_back({0, 1, 2, 4});
  CHECK(refusal(mesh).find("tetrahedra #0 and #1 lie on the same side") != std::string::npos);
  mesh.points.back() = {0.2, 0.2, -1};
  CHECK(refusal(oriented(mesh)).empty());
}

TEST_CASE("what cannot be numbered is refused before it is looked up") {
  TetrahedralMesh mesh = one_tetrahedron();
  mesh.tetrahedra[0][2] = 4;
  CHECK_THROWS_WITH(oriented(mesh), Catch::Contains("tetrahedron #0 names point 4"));
  CHECK_THROWS_WITH(box_mesh({1, 1, 1}, {100000, 100000, 100000}),
                    Catch::Contains("more than an index counts"));
}

TEST_CASE("a tetrahedron that is flat, inside out or names no point is refused by its number") {
  TetrahedralMesh mesh = box_mesh({1, 1, 1}, {1, 1, 1});
  std::swap(mesh.tetrahedra[3][0], mesh.tetrahedra[3][1]);
  CHECK(refusal(mesh).find("tetrahedron #3 is inside out") != std::string::npos);
  CHECK(refusal(oriented(mesh)).empty());

  mesh = box_mesh({1, 1, 1e-10}, {1, 1, 1});
  CHECK(refusal(mesh).find("tetrahedron #0 is flat") != std::string::npos);
  CHECK(refusal(box_mesh({1, 1, 1e-3}, {1, 1, 1})).empty());

  mesh = one_tetrahedron();
  mesh.tetrahedra[0][2] = 4;
  CHECK(refusal(mesh).find("names point 4, but the mesh has points 0 to 3") != std::string::npos);
  mesh = one_tetrahedron();
  mesh.points.push_back({2, 2, 2});
  CHECK(refusal(mesh).find("point #4 belongs to no tetrahedron") != std::string::npos);
  mesh.points[1][0] = 0.0 / std::sin(0.0);
  CHECK(refusal(mesh).find("point #1 of the mesh is not finite") != std::string::npos);
  CHECK(refusal(TetrahedralMesh{}).find("has no tetrahedron") != std::string::npos);
  CHECK_THROWS_AS(box_mesh({1, 0, 1}, {1, 1, 1}), InvalidArgument);
  CHECK_THROWS_AS(box_mesh({1, 1, 1}, {1, 0, 1}), InvalidArgument);
}

TEST_CASE("of the 24 orders of a tetrahedron's points twelve are inside out") {
  std::array<Index, 4> order{0, 1, 2, 3};
  int accepted = 0;
  do {
    TetrahedralMesh mesh = one_tetrahedron();
    mesh.tetrahedra[0] = order;
    accepted += refusal(mesh).empty();
    CHECK(refusal(oriented(mesh)).empty());
  } while (std::next_permutation(order.begin(), order.end()));
  CHECK(accepted == 12);
}
