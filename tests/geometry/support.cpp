#include "catch.hpp"

#include <delassus/geometry/face.hpp>
#include <delassus/geometry/support.hpp>

#include <cmath>
#include <random>
#include <vector>

using namespace delassus;

namespace {

struct Shapes {
  ConvexHull hull{std::vector<Vec3>{{1, 0, -1}, {-1, 1, -1}, {-1, -1, -1}, {0.2, 0.1, 2}, {0.5, 0.6, 0.4}}};
  std::vector<Shape> all{
      Sphere{0.4}, Box{1, 0.6, 0.8}, Capsule{0.25, 0.8}, Cylinder{0.35, 0.8}, hull, Cone{0.4, 0.9}, Ellipsoid{0.5, 0.3, 0.4}};
};

Vec3 direction(std::mt19937& random) {
  std::normal_distribution<double> normal;
  const double x = normal(random), y = normal(random), z = normal(random);
  return Vec3(x, y, z).normalized();
}

}  // namespace

TEST_CASE("no support point lies beyond another's plane") {
  std::mt19937 random(1);
  const Shapes shapes;
  for (const Shape& s : shapes.all) {
    std::vector<Vec3> directions, points;
    for (int i = 0; i < 100; ++i) {
      directions.push_back(direction(random));
      points.push_back(support(s, directions.back()));
    }
    for (int i = 0; i < 100; ++i)
      for (int j = 0; j < 100; ++j)
        CHECK(directions[i].dot(points[j]) <= directions[i].dot(points[i]) + 1e-15);
  }
}

TEST_CASE("the tight box touches the body on all six sides") {
  const Shapes shapes;
  for (const Shape& s : shapes.all) {
    const Pose pose{.position = {1, 2, 3},
                    .rotation = Quat(0.1, 0.2, 0.3, 0.4).normalized().toRotationMatrix()};
    const Aabb box = tight_box(s, pose);
    for (int k = 0; k < 3; ++k) {
      const Vec3 axis = pose.rotation.transpose().col(k);
      CHECK(box.max()[k] == Approx(pose.to_world(support(s, axis))[k]).epsilon(1e-14));
      CHECK(box.min()[k] == Approx(pose.to_world(support(s, Vec3(-axis)))[k]).epsilon(1e-14));
    }
  }
  CHECK(tight_box(Shape{}, Pose{}).is_empty());
  CHECK(std::isinf(tight_box(HalfSpace{}, Pose{}).max()[0]));
}

TEST_CASE("a face holds the support point, looks outward and lies in its plane") {
  std::mt19937 random(3);
  const Shapes shapes;
  for (const Shape& s : shapes.all)
    for (int i = 0; i < 200; ++i) {
      const Vec3 d = direction(random), reach = support(s, d);
      const Face face = face_towards(s, d);
      if (face.count < 3) continue;
      CHECK(face.normal.dot(d) > 0);
      double highest = -10;
      for (int k = 0; k < face.count; ++k) {
        highest = std::max(highest, d.dot(face.point[k]));
        CHECK(std::abs(face.normal.dot(face.point[k] - face.point[0])) < 1e-14);
        const Vec3 edge = face.point[(k + 1) % face.count] - face.point[k];
        CHECK(edge.cross(face.point[(k + 2) % face.count] - face.point[k]).dot(face.normal) > 0);
      }
      CHECK(highest <= d.dot(reach) + 1e-15);
      CHECK(highest >= d.dot(reach) - 1e-15);
    }
}

// Up to a slope of 2e-3 the corners stay where they are on the body, but for one within 1e-3 r of the lowest point.
TEST_CASE("a cap that leans by more than 1e-6 has the lowest point of its rim, and one that lies flat its corners") {
  const double r = 0.3;
  for (const Shape& s : {Shape(Cylinder{r, 0.8}), Shape(Cone{r, 0.8})})
    for (const double slope : {0.9e-6, 1.1e-6, 1.9e-3, 2.1e-3, 0.1})
      for (int i = 0; i < 720; ++i) {
        const double angle = i * M_PI / 360 + 1e-4, from_corner = std::remainder(angle, M_PI / 4);
        const Vec3 d = Vec3(slope * std::cos(angle), slope * std::sin(angle), -1).normalized();
        const Face flat = face_towards(s, -Vec3::UnitZ()), face = face_towards(s, d);
        const bool leans = slope > 1e-6, is_beside = leans && std::abs(from_corner) < 1e-3, is_turned = slope > 2e-3;
        CAPTURE(name(s.kind), slope, angle);
        REQUIRE(face.count == (leans && !is_beside && !is_turned ? 9 : 8));
        int corners = 0, lowest = 0;
        for (int k = 0; k < face.count; ++k) {
          for (int j = 0; j < 8; ++j)
            corners += face.corner[k] == flat.corner[j] && face.point[k] == flat.point[j];
          lowest += face.corner[k] == Face::lowest_of_rim && (face.point[k] - support(s, d)).norm() < 1e-15;
          const Vec3 edge = face.point[(k + 1) % face.count] - face.point[k];
          CHECK(edge.cross(face.point[(k + 2) % face.count] - face.point[k]).dot(face.normal) > 0);
        }
        if (!is_turned) CHECK(corners == (is_beside ? 7 : 8));
        CHECK(lowest == (leans ? 1 : 0));
      }
}

TEST_CASE("a corner keeps its name in every face it belongs to") {
  const Shape box = Box{1, 1, 1};
  const Face up = face_towards(box, Vec3::UnitZ()), side = face_towards(box, Vec3::UnitX());
  int shared = 0;
  for (int i = 0; i < 4; ++i)
    for (int j = 0; j < 4; ++j) {
      CHECK((up.corner[i] == side.corner[j]) == (up.point[i] == side.point[j]));
      shared += up.corner[i] == side.corner[j];
    }
  CHECK(shared == 2);
}

TEST_CASE("a capsule offers a line only when it lies, a cylinder a cap or a line, a sphere nothing") {
  CHECK(face_towards(Capsule{0.2, 1}, Vec3::UnitX()).count == 2);
  CHECK(face_towards(Capsule{0.2, 1}, Vec3(1, 0, 0.1).normalized()).count == 0);
  CHECK(face_towards(Cylinder{0.2, 1}, Vec3::UnitZ()).count == 8);
  CHECK(face_towards(Cylinder{0.2, 1}, Vec3::UnitX()).count == 2);
  CHECK(face_towards(Sphere{1}, Vec3::UnitX()).count == 0);
  CHECK(face_towards(Ellipsoid{1, 2, 3}, Vec3::UnitX()).count == 0);
}

TEST_CASE("a cone stands on its base, lies on a line of its mantle, and is sharp at its tip") {
  const Shape cone = Cone{0.3, 0.4};  // the mantle's slant is 0.5, its normal (0.8, 0, 0.6)
  CHECK(face_towards(cone, -Vec3::UnitZ()).count == 8);
  CHECK(face_towards(cone, Vec3::UnitZ()).count == 0);
  const Face line = face_towards(cone, Vec3(0.8, 0, 0.6));
  REQUIRE(line.count == 2);
  CHECK((line.point[0] - Vec3(0, 0, 0.3)).norm() < 1e-15);
  CHECK((line.point[1] - Vec3(0.3, 0, -0.1)).norm() < 1e-15);
  CHECK((support(cone, Vec3(0.79, 0, 0.62)) - Vec3(0, 0, 0.3)).norm() < 1e-15);
  CHECK((support(cone, Vec3(0.81, 0, 0.58)) - Vec3(0.3, 0, -0.1)).norm() < 1e-15);
  CHECK(outer_radius(cone) == Approx(std::hypot(0.3, 0.1)));
  CHECK(outer_radius(Cone{0.3, 1.2}) == Approx(0.9));
}

TEST_CASE("an ellipsoid's support point has its tangent plane normal to the direction") {
  std::mt19937 random(5);
  const Vec3 axes(0.5, 0.3, 0.4);
  for (int i = 0; i < 50; ++i) {
    const Vec3 n = direction(random), p = support(Ellipsoid{0.5, 0.3, 0.4}, n);
    CHECK(p.cwiseQuotient(axes).norm() == Approx(1).epsilon(1e-14));
    CHECK((p.cwiseQuotient(axes.cwiseAbs2()).normalized() - n).norm() < 1e-14);
  }
}

TEST_CASE("a face of a hull with more than sixteen corners is sampled evenly") {
  std::vector<Vec3> points;
  for (int i = 0; i < 64; ++i)
    for (const double z : {-1.0, 1.0})
      points.push_back({std::cos(i * M_PI / 32), std::sin(i * M_PI / 32), z});
  const ConvexHull hull(points);
  const Face face = face_towards(hull, Vec3::UnitZ());
  CHECK(face.count == Face::capacity);
  Vec3 mean = Vec3::Zero();
  for (int k = 0; k < face.count; ++k) mean += face.point[k] / face.count;
  CHECK((mean - Vec3::UnitZ()).norm() < 1e-14);
}
