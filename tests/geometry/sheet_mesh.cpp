#include <delassus/geometry/sheet_mesh.hpp>

#include <cmath>

#include "catch.hpp"
#include "geometry/mesh_refusals.hpp"

namespace sheet_mesh_tests {

using namespace delassus;

TEST_CASE("the triangles of a rectangle fill it, and its two sides close around nothing") {
  const SheetMesh mesh = sheet(2, 3, {4, 5}, 0.1);
  check_mesh(mesh, "sheet");
  CHECK(mesh.points.size() == 5 * 6);
  CHECK(mesh.triangles.size() == 2 * 4 * 5);
  double sum = 0;
  for (Index e = 0; e < 40; ++e) sum += volume(mesh, e);
  CHECK(std::abs(sum - 0.6) < 1e-15);
  const auto faces = outer_faces(mesh);
  CHECK(faces.size() == 80);
  Vec3 total = Vec3::Zero();
  for (const OuterFace& f : faces) {
    const auto& [a, b, c] = f.triangle;
    total += (mesh.points[b] - mesh.points[a]).cross(mesh.points[c] - mesh.points[a]);
  }
  CHECK(total.norm() < 1e-14);  // 80 roundings of 0.3 m²
}

TEST_CASE("what is no sheet is refused by its number") {
  const SheetMesh good = sheet(1, 1, {2, 2}, 1e-3);
  CHECK(refusal(good).empty());
  SheetMesh mesh;
  CHECK(says(refusal(mesh), "the mesh has no triangle"));
  for (const double thickness : {0., -1., std::nan(""), HUGE_VAL}) {
    mesh = good;
    mesh.thickness = thickness;
    CHECK(says(refusal(mesh), "m must be finite and > 0"));
  }
  mesh = good;
  mesh.points[4][1] = std::nan("");
  CHECK(says(refusal(mesh), "point #4 of the mesh is not finite"));
  mesh = good;
  mesh.triangles[3][1] = 9;
  CHECK(says(refusal(mesh), "triangle #3 names point 9, but the mesh has points 0 to 8"));
  mesh = good;
  mesh.points[1] = {0.5, 0.5 - 1e-8, 0};
  CHECK(says(refusal(mesh), "triangle #0 has no area"));
  mesh = good;
  mesh.points.push_back({0, 0, 1});
  CHECK(says(refusal(mesh), "point #9 belongs to no triangle"));
  mesh.triangles.push_back({0, 4, 9});  // a third one on the first diagonal
  CHECK(says(refusal(mesh), "triangles #0 and #1 share an edge with #8"));
  mesh = good;
  std::swap(mesh.triangles[1][1], mesh.triangles[1][2]);
  CHECK(says(refusal(mesh), "are turned to different sides"));
  mesh = good;
  mesh.triangles.push_back({mesh.triangles[2][1], mesh.triangles[2][2], mesh.triangles[2][0]});
  CHECK(says(refusal(mesh), "triangles #2 and #8 have the same points"));
  std::swap(mesh.triangles[8][0], mesh.triangles[8][1]);  // as exporters write both sides of a face
  CHECK(says(refusal(mesh), "triangles #2 and #8 have the same points"));
  mesh.points.resize(3);  // a pillow of two, whose every edge has two triangles that agree
  mesh.points[2] = {0, 1, 0};
  mesh.triangles = {{0, 1, 2}, {0, 2, 1}};
  CHECK(says(refusal(mesh), "triangles #0 and #1 have the same points"));
  const SheetMesh same = sheet(TriangleMesh(good.points, good.triangles), 1e-3);
  CHECK(same.points == good.points);
  CHECK(same.triangles == good.triangles);
  CHECK_THROWS_AS(sheet(1, 0, {2, 2}, 1e-3), InvalidArgument);
  CHECK_THROWS_AS(sheet(1, 1, {2, 0}, 1e-3), InvalidArgument);
}

}  // namespace sheet_mesh_tests
