#include "catch.hpp"
#include "collision/samples.hpp"
#include "collision/scene.hpp"

#include <cmath>
#include <vector>

namespace half_space_tests {

using namespace delassus;
using namespace scenes;

namespace {

/// A plane through the origin that leans by 0.3 rad, and a body over it; the plane is the first or the second
/// collider.
Scene on_slope(const Shape& body, const Mat3& rotation, double gap, bool plane_is_first) {
  const Mat3 slope = turned(0.3, Vec3::UnitY());
  const Mat3 R = slope * rotation;
  const Vec3 n = slope.col(2);
  const double low = n.dot(R * support(body, Vec3(-(R.transpose() * n))));
  Scene scene;
  const Shape ground = HalfSpace{n, 0};
  if (plane_is_first) scene.add(ground, Vec3::Zero(), Mat3::Identity(), false);
  scene.add(body, (gap - low) * n + slope.col(0), R);
  if (!plane_is_first) scene.add(ground, Vec3::Zero(), Mat3::Identity(), false);
  return scene;
}

}  // namespace

TEST_CASE("on a half-space every corner of the lowest face is a contact at the plane's own distance") {
  const ConvexHull cube = cube_hull();
  struct Row {
    Shape body;
    Mat3 rotation;
    std::size_t contacts;
  };
  const Mat3 lying = turned(std::acos(0.0), Vec3::UnitX());
  const std::vector<Row> rows{
      {Sphere{0.5}, Mat3::Identity(), 1},
      {Box{1, 2, 3}, Mat3::Identity(), 4},
      {Box{1, 1, 1}, turned(0.5, Vec3::UnitX()), 2},
      {cube, Mat3::Identity(), 4},
      {Cylinder{0.4, 1}, Mat3::Identity(), 4},
      {Cylinder{0.4, 1}, lying, 2},
      {Capsule{0.3, 1}, lying, 2},
      {Cone{0.3, 0.4}, Mat3::Identity(), 4},
      {Cone{0.3, 0.4}, turned(std::acos(-1.0), Vec3::UnitX()), 1},
      {Cone{0.3, 0.4}, turned(std::acos(0.0) + std::atan2(0.3, 0.4), Vec3::UnitX()), 2},
      {Ellipsoid{0.5, 0.3, 0.4}, turned(0.7, Vec3(1, 2, 3)), 1},
      {Capsule{0.3, 1}, Mat3::Identity(), 1}};
  for (const Row& row : rows)
    for (const bool plane_is_first : {true, false})
      for (const double gap : {0.0, 1e-16, -1e-16, 1e-10, -1e-10, 1e-4, -1e-4, -0.4}) {
        Scene scene = on_slope(row.body, row.rotation, gap, plane_is_first);
        scene.detect();
        CAPTURE(name(row.body.kind), gap, plane_is_first);
        REQUIRE(scene.contacts.size() == row.contacts);
        const Vec3 out = turned(0.3, Vec3::UnitY()).col(2);
        for (const ContactPoint& c : scene.contacts) {
          CHECK((c.normal - (plane_is_first ? out : Vec3(-out))).norm() < 1e-15);
          CHECK(std::abs(c.gap - gap) < 1e-14);
          CHECK((c.point_b - c.point_a - c.gap * c.normal).norm() < 1e-14);
        }
      }
}

// Also a hundredth of a radian from a corner of the octagon that a flat cap has.
TEST_CASE("a tilted cylinder touches with its exact rim") {
  for (const double tilt : {0.01, 0.1, 0.5, 1.0})
    for (const double beside : {0.37, 0.01}) {
      Scene scene = on_slope(Cylinder{0.5, 1}, turned(tilt, Vec3(1, beside, 0)), -1e-3, true);
      scene.detect();
      double deepest = 1;
      for (const ContactPoint& c : scene.contacts) deepest = std::min(deepest, c.gap);
      CAPTURE(tilt, beside);
      CHECK(std::abs(deepest + 1e-3) < 1e-14);
    }
}

TEST_CASE("the solid of a half-space has no bottom: far below the plane means deep") {
  Scene scene = on_slope(Sphere{0.5}, Mat3::Identity(), -1000, true);
  scene.detect();
  REQUIRE(scene.contacts.size() == 1);
  CHECK(scene.contacts[0].gap == Approx(-1000));
}

TEST_CASE("a half-space moves with its body") {
  Scene scene;
  scene.add(HalfSpace{}, {0, 0, 2}, turned(std::acos(-1.0), Vec3::UnitX()), false);  // a ceiling at z = 2
  scene.add(Sphere{0.5}, {0, 0, 1.5});
  scene.detect();
  REQUIRE(scene.contacts.size() == 1);
  CHECK(scene.contacts[0].normal[2] == Approx(-1));
  CHECK(std::abs(scene.contacts[0].gap) < 1e-14);
}

}  // namespace half_space_tests
