#include "catch.hpp"

#include <delassus/geometry/height_field.hpp>
#include <delassus/geometry/triangle_mesh.hpp>

#include <algorithm>
#include <cmath>
#include <limits>
#include <random>
#include <vector>

using namespace delassus;
using Catch::Matchers::Contains;

namespace {

using Corners = std::array<Index, 3>;

TriangleMesh mesh(const std::vector<Vec3>& v, const std::vector<Corners>& t) { return TriangleMesh(v, t); }

/// Triangles of edges about 0.2 m thrown into the unit cube.
struct Cloud {
  std::vector<Vec3> vertices;
  std::vector<Corners> triangles;
  Cloud(int count, unsigned seed) {
    std::mt19937 random(seed);
    std::uniform_real_distribution<double> uniform;
    const auto any = [&] { return Vec3{uniform(random), uniform(random), uniform(random)}; };
    for (int t = 0; t < count; ++t) {
      const Vec3 at = any();
      for (int k = 0; k < 3; ++k) vertices.push_back(at + 0.2 * any());
      triangles.push_back({3 * t, 3 * t + 1, 3 * t + 2});
    }
  }
};

inner::Bounds bounds_of(const Triangle& t) {
  inner::Bounds b;
  for (const Vec3& p : t.point) b.add(p);
  return b;
}

}  // namespace

TEST_CASE("a mesh that cannot be is refused by the number of its element") {
  const std::vector<Vec3> v{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}, {2, 0, 0}, {0, -1, 0}};
  const double nan = std::numeric_limits<double>::quiet_NaN(), inf = std::numeric_limits<double>::infinity();
  CHECK_THROWS_WITH(mesh(v, {}), Contains("at least one triangle"));
  CHECK_THROWS_WITH(mesh(v, {{0, 1, 2}, {0, 1, 6}}),
                    Contains("mesh triangle #1: vertex index 6 must be in [0, 6)"));
  CHECK_THROWS_WITH(mesh(v, {{0, -1, 2}}), Contains("vertex index -1"));
  CHECK_THROWS_WITH(mesh({{0, 0, 0}, {1, 0, nan}, {0, 1, 0}}, {{0, 1, 2}}),
                    Contains("mesh vertex #1 is not finite"));
  CHECK_THROWS_WITH(mesh({{0, 0, 0}, {1, 0, 0}, {0, inf, 0}}, {{0, 1, 2}}),
                    Contains("mesh vertex #2 is not finite"));
  CHECK_THROWS_WITH(mesh(v, {{0, 1, 2}, {0, 1, 4}}),
                    Contains("mesh triangle #1 is flat"));                        // three in a line
  CHECK_THROWS_WITH(mesh(v, {{0, 0, 2}}), Contains("mesh triangle #0 is flat"));  // twice the same
  CHECK_THROWS_WITH(mesh({{0, 0, 0}, {1, 0, 0}, {0.5, 1e-7, 0}}, {{0, 1, 2}}), Contains("#0 is flat"));
  CHECK_THROWS_WITH(mesh({{0, 0, 0}, {1, 0, 0}, {0, 1e-7, 0}}, {{0, 1, 2}}),
                    Contains("#0 is flat"));  // a needle
  CHECK_THROWS_WITH(mesh(v, {{0, 1, 2}, {1, 0, 3}, {0, 1, 5}}),
                    Contains("mesh edge (0, 1)") && Contains("at most two"));
  CHECK_THROWS_WITH(mesh(v, {{0, 1, 2}, {0, 1, 3}}),
                    Contains("mesh edge (0, 1): triangles #0 and #1 run through it in one"));
  CHECK_NOTHROW(mesh({{0, 0, 0}, {1, 0, 0}, {0.5, 1e-5, 0}}, {{0, 1, 2}}));
}

TEST_CASE("normals may lean over an edge as far as the surface bends there") {
  // A floor and a second triangle across the edge (0, 1), turned down by an angle: lean = its sine, or 1 from
  // 90° on.
  for (const double angle : {-0.5, 0.0, 0.3, 1.2, 2.0, 3.14159265358979}) {
    const Vec3 far(0.4, -std::cos(angle), -std::sin(angle));
    const TriangleMesh m = mesh({{0, 0, 0}, {1, 0, 0}, {0.3, 1, 0}, far}, {{0, 1, 2}, {1, 0, 3}});
    const double expected = angle <= 0 ? 0 : angle < 1.57 ? std::sin(angle) : 1;
    CHECK(std::abs(m.triangle(0).lean[0] - expected) < 1e-14);
    CHECK(std::abs(m.triangle(1).lean[0] - expected) < 1e-14);
    CHECK(m.triangle(0).lean[1] == 1);  // a border
  }
}

TEST_CASE("the tree finds the triangles whose boxes meet a box") {
  const Cloud cloud(300, 5);
  const TriangleMesh m(cloud.vertices, cloud.triangles);
  std::mt19937 random(9);
  std::uniform_real_distribution<double> uniform;
  for (int q = 0; q < 50; ++q) {
    inner::Bounds box;
    box.add(Vec3{uniform(random), uniform(random), uniform(random)});
    box.add(Vec3(box.low + 0.3 * Vec3{uniform(random), uniform(random), uniform(random)}));
    std::vector<Index> found;
    m.visit([&](const inner::Bounds& b) { return b.meets(box); },
            [&](Index t) {
              if (bounds_of(m.triangle(t)).meets(box)) found.push_back(t);
            });
    std::vector<Index> expected;
    for (Index t = 0; t < m.triangle_count(); ++t)
      if (bounds_of(m.triangle(t)).meets(box)) expected.push_back(t);
    std::sort(found.begin(), found.end());
    CHECK(found == expected);
  }
}

TEST_CASE("a height field is the mesh of its triangles") {
  std::mt19937 random(3);
  std::uniform_real_distribution<double> uniform;
  std::vector<double> heights;
  for (int i = 0; i < 5 * 4; ++i) heights.push_back(uniform(random));
  const HeightField field(5, 4, 0.5, 0.25, heights);
  CHECK(field.point(0, 0) == Vec3(-1, -0.375, heights[0]));
  CHECK(field.point(4, 3) == Vec3(1, 0.375, heights[19]));
  REQUIRE(field.triangle_count() == 24);
  std::vector<Vec3> vertices;
  std::vector<Corners> triangles;
  for (Index j = 0; j < 4; ++j)
    for (Index i = 0; i < 5; ++i) vertices.push_back(field.point(i, j));
  for (Index t = 0; t < field.triangle_count(); ++t) triangles.push_back(field.triangle(t).corner);
  const TriangleMesh m(vertices, triangles);  // refuses what does not fit together
  for (Index t = 0; t < m.triangle_count(); ++t) {
    CHECK(m.triangle(t).normal == field.triangle(t).normal);
    CHECK(m.triangle(t).normal[2] > 0);
    CHECK(m.triangle(t).lean == field.triangle(t).lean);
  }
}

TEST_CASE("a height field that cannot be is refused") {
  const std::vector<double> four{0, 0, 0, 0};
  const double inf = std::numeric_limits<double>::infinity();
  CHECK_THROWS_WITH(HeightField(1, 4, 1, 1, four), Contains("1 x 4 points has no cell"));
  CHECK_THROWS_WITH(HeightField(2, 2, 0, 1, four), Contains("spacing (0, 1) m must be finite and > 0"));
  CHECK_THROWS_WITH(HeightField(2, 3, 1, 1, four), Contains("got 4 heights for 2 x 3 points"));
  CHECK_THROWS_WITH(HeightField(2, 2, 1, 1, std::vector<double>{0, 0, inf, 0}),
                    Contains("height #2 is not finite"));
  CHECK_THROWS_WITH(HeightField(2, 2, 1, 1, std::vector<double>{0, 0, 1e9, 0}),
                    Contains("triangle #1 is flatter"));
}
