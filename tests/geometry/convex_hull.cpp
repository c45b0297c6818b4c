#include "catch.hpp"

#include <delassus/geometry/convex_hull.hpp>

#include <cmath>
#include <limits>
#include <random>
#include <vector>

using namespace delassus;
using Catch::Matchers::Contains;

namespace {

std::vector<Vec3> grid(int n, const Vec3& size) {
  std::vector<Vec3> points;
  for (int i = 0; i <= n; ++i)
    for (int j = 0; j <= n; ++j)
      for (int k = 0; k <= n; ++k)
        points.push_back((Vec3(i, j, k) / double(n) - Vec3::Constant(0.5)).cwiseProduct(size));
  return points;
}

/// Closed, convex, outward, and around all the points: V − E + F = 2, no point above any face.
void check_hull(const ConvexHull& hull, std::span<const Vec3> points, double size) {
  std::size_t edges2 = 0;
  for (Index f = 0; f < hull.face_count(); ++f) {
    const auto loop = hull.face(f);
    edges2 += loop.size();
    CHECK(std::abs(hull.normal(f).norm() - 1) < 1e-12);
    const Vec3 &a = hull.vertices()[loop[0]], &b = hull.vertices()[loop[1]], &c = hull.vertices()[loop[2]];
    CHECK((b - a).cross(c - b).dot(hull.normal(f)) > 0);
    double highest = -size;
    for (const Vec3& p : points) highest = std::max(highest, hull.normal(f).dot(p - a));
    CHECK(highest <= 1e-7 * size);  // the tolerance within which coplanar triangles are merged
  }
  CHECK(hull.vertices().size() + std::size_t(hull.face_count()) == edges2 / 2 + 2);
}

}  // namespace

TEST_CASE("a grid of points in a box has six faces with four corners each") {
  const std::vector<Vec3> points = grid(4, {1, 2, 3});
  const ConvexHull hull(points);
  CHECK(hull.vertices().size() == 8);
  REQUIRE(hull.face_count() == 6);
  for (Index f = 0; f < 6; ++f) CHECK(hull.face(f).size() == 4);
  for (Index v = 0; v < 8; ++v) CHECK(hull.faces_around(v).size() == 3);
  CHECK(hull.inner_radius() == Approx(0.5));
  CHECK(hull.outer_radius() == Approx(0.5 * std::sqrt(14.0)));
}

TEST_CASE("faces survive noise of rounding size, any orientation and any scale") {
  std::mt19937 random(3);
  std::normal_distribution<double> normal;
  for (const double scale : {1e-6, 1.0, 1e6})
    for (int trial = 0; trial < 20; ++trial) {
      const Mat3 R = Quat{normal(random), normal(random), normal(random), normal(random)}
                         .normalized()
                         .toRotationMatrix();
      std::vector<Vec3> points = grid(3, {1, 1, 0.01});
      for (Vec3& p : points)
        p = scale * (R * p + Vec3(5, 6, 7) + 1e-15 * Vec3{normal(random), normal(random), normal(random)});
      const ConvexHull hull(points);
      CHECK(hull.vertices().size() == 8);
      CHECK(hull.face_count() == 6);
      check_hull(hull, points, scale);
    }
}

TEST_CASE("the hull of random points holds them all and obeys Euler") {
  std::mt19937 random(11);
  std::normal_distribution<double> normal;
  for (const int count : {4, 5, 20, 300}) {
    std::vector<Vec3> points;
    for (int i = 0; i < count; ++i) points.push_back({normal(random), normal(random), normal(random)});
    check_hull(ConvexHull(points), points, 5);
  }
}

TEST_CASE("repeated points and prisms with round rims are no trouble") {
  std::vector<Vec3> points;
  for (int i = 0; i < 64; ++i)
    for (const double z : {-1.0, 1.0})
      points.push_back({std::cos(i * M_PI / 32), std::sin(i * M_PI / 32), z});
  const std::vector<Vec3> once = points;
  points.insert(points.end(), once.begin(), once.end());
  const ConvexHull hull(points);
  CHECK(hull.vertices().size() == 128);
  CHECK(hull.face_count() == 66);
  check_hull(hull, points, 1);
}

TEST_CASE("centred() moves the centre of volume to the origin and nothing else") {
  const ConvexHull hull(std::vector<Vec3>{{1, 0, 0}, {3, 0, 0}, {1, 4, 0}, {1, 0, 8}});
  const ConvexHull moved = hull.centred();
  CHECK(moved.centroid() == Vec3::Zero());
  CHECK(moved.vertices()[2] == hull.vertices()[2] - hull.centroid());
  CHECK(moved.second_moment() == hull.second_moment());
}

TEST_CASE("a cloud that spans no volume is refused with what is wrong") {
  const double nan = std::numeric_limits<double>::quiet_NaN();
  using Points = std::vector<Vec3>;
  CHECK_THROWS_WITH(ConvexHull(Points{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}}),
                    Contains("at least 4 points, got 3"));
  CHECK_THROWS_WITH(ConvexHull(Points{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, nan, 1}}),
                    Contains("point #3 is not finite"));
  CHECK_THROWS_WITH(ConvexHull(Points{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {1, 1, 0}}),
                    Contains("lie in one plane"));
  CHECK_THROWS_WITH(ConvexHull(Points{{0, 0, 0}, {1, 1, 1}, {2, 2, 2}, {3, 3, 3}}), Contains("on one line"));
  CHECK_THROWS_WITH(ConvexHull(Points(5, Vec3(1, 2, 3))), Contains("span 0 m"));
}
