#include "catch.hpp"
#include "collision/scene.hpp"

#include <cmath>
#include <vector>

namespace manifold_tests {

using namespace delassus;
using namespace scenes;

namespace {

const double half_turn = std::acos(-1.0);

/// The floor is a box, 0.5 above the origin at its top; `gap` below the body's lowest point.
Scene on_floor(const Shape& body, const Mat3& rotation, double gap) {
  Scene scene;
  scene.add(Box{10, 10, 1}, {0, 0, 0}, Mat3::Identity(), false);
  const double low = (rotation * support(body, Vec3(-rotation.row(2).transpose())))[2];
  scene.add(body, {0.1, 0.2, 0.5 - low + gap}, rotation);
  return scene;
}

}  // namespace

TEST_CASE("each way of resting has its number of contacts, touching, sunk in and hovering") {
  const ConvexHull cube = cube_hull();
  const Mat3 upright = Mat3::Identity(), lying = turned(half_turn / 2, Vec3::UnitX());
  struct Row {
    const char* what;
    Shape body;
    Mat3 rotation;
    std::size_t contacts;
  };
  const std::vector<Row> rows{
      {"sphere", Sphere{0.5}, upright, 1},
      {"box on its face", Box{1, 1, 1}, upright, 4},
      {"box on its face, turned", Box{1, 1, 1}, turned(0.5, Vec3::UnitZ()), 4},
      {"box on an edge", Box{1, 1, 1}, turned(half_turn / 4, Vec3::UnitX()), 2},
      {"box on an edge, not balanced", Box{1, 1, 1}, turned(0.5, Vec3::UnitX()), 2},
      {"box on a corner", Box{1, 1, 1}, turned(0.5, Vec3::UnitX()) * turned(0.6, Vec3::UnitY()), 1},
      {"cube hull on its face", cube, upright, 4},
      {"cube hull on an edge", cube, turned(half_turn / 4, Vec3::UnitX()), 2},
      {"standing cylinder", Cylinder{0.4, 1}, upright, 8},
      {"lying cylinder", Cylinder{0.4, 1}, lying, 2},
      {"cylinder on its rim", Cylinder{0.4, 1}, turned(0.5, Vec3::UnitX()), 1},
      {"lying capsule", Capsule{0.3, 1}, lying, 2},
      {"standing capsule", Capsule{0.3, 1}, upright, 1},
      {"standing cone", Cone{0.3, 0.4}, upright, 8},
      {"cone on its tip", Cone{0.3, 0.4}, turned(half_turn, Vec3::UnitX()), 1},
      {"lying cone", Cone{0.3, 0.4}, turned(half_turn / 2 + std::atan2(0.3, 0.4), Vec3::UnitX()), 2},
      {"ellipsoid", Ellipsoid{0.5, 0.3, 0.4}, turned(0.7, Vec3(1, 2, 3)), 1},
  };
  for (const Row& row : rows)
    for (const double gap : {0.0, -1e-4, 1e-4, 1e-12, -1e-12}) {
      Scene scene = on_floor(row.body, row.rotation, gap);
      scene.collision.max_points = 8;
      scene.detect();
      CAPTURE(row.what, gap);
      CHECK(scene.contacts.size() == row.contacts);
      for (const ContactPoint& c : scene.contacts) {
        CHECK((c.normal - Vec3::UnitZ()).norm() < 1e-9);
        CHECK(std::abs(c.gap - gap) < 1e-9);
        CHECK((c.point_b - c.point_a - c.gap * c.normal).norm() < 1e-14);
      }
    }
}

TEST_CASE("the corners of a patch are the corners of the overlap") {
  Scene scene;
  scene.add(Box{1, 1, 1}, {0, 0, 0}, Mat3::Identity(), false);
  scene.add(Box{1, 1, 1}, {0.3, -0.2, 0.9999}, Mat3::Identity());
  scene.detect();
  REQUIRE(scene.contacts.size() == 4);
  // The overlap is [−0.2, 0.5] × [−0.5, 0.3]; a corner may lie outside a side by 1e-7 of the scale.
  for (const ContactPoint& c : scene.contacts) {
    const double x = c.point_a[0] < 0.15 ? -0.2 : 0.5, y = c.point_a[1] < -0.1 ? -0.5 : 0.3;
    CHECK(std::abs(c.point_a[0] - x) < 1e-6);
    CHECK(std::abs(c.point_a[1] - y) < 1e-6);
    CHECK(c.gap == Approx(-1e-4).epsilon(1e-9));
  }
}

TEST_CASE("an octagon of eight corners is reduced to four that span half of it") {
  for (const int limit : {4, 8}) {
    Scene scene;
    scene.collision.max_points = limit;
    scene.add(Box{1, 1, 1}, {0, 0, 0}, Mat3::Identity(), false);
    scene.add(Box{1, 1, 1}, {0, 0, 1}, turned(half_turn / 4, Vec3::UnitZ()));
    scene.detect();
    CHECK(scene.contacts.size() == std::size_t(limit));
    if (limit == 4) {
      // A regular octagon of circumradius R has the area 2√2 R², the square of four of its corners 2 R².
      std::vector<Vec3> points;
      for (const ContactPoint& c : scene.contacts) points.push_back(c.point_a);
      CHECK(area(points) > 0.5 * 8 * (std::sqrt(2.0) - 1) / 4);
    }
  }
}

// The end of a stretch lies up to 0.5 m from the crossing, beside the other line by 0.5 of the angle: (0.5 angle)²/2r farther off.
TEST_CASE("lines that are parallel meet in a stretch, those that cross at 1e-3 also where they do, others in a point") {
  for (const Shape& rod : {Shape(Capsule{0.2, 1}), Shape(Cylinder{0.2, 1})})
    for (const double angle : {0.0, 1e-9, 1e-3, 0.5, half_turn / 2}) {
      Scene scene;
      const Mat3 lying = turned(half_turn / 2, Vec3::UnitX());
      scene.add(rod, {0, 0, 0}, lying, false);
      scene.add(rod, {0, 0.3, 0.4}, turned(angle, Vec3::UnitZ()) * lying);
      if (angle > 0.1) scene.colliders[1].pose.position[1] = 0;
      scene.detect();
      CAPTURE(angle, name(rod.kind));
      REQUIRE(scene.contacts.size() == (angle < 1e-6 ? 2u : angle < 0.05 ? 3u : 1u));
      if (angle > 0.05) continue;
      const std::size_t end = scene.contacts.size() - 1;
      CHECK((scene.contacts[end - 1].point_a - scene.contacts[end].point_a).norm() == Approx(0.7).epsilon(1e-3));
      if (end == 2) CHECK(scene.contacts[0].point_a.y() == Approx(0.3).epsilon(1e-2));
      for (std::size_t k = 0; k <= end; ++k) CHECK(std::abs(scene.contacts[k].gap) < 0.63 * angle * angle + 1e-15);
    }
}

TEST_CASE("an edge on a face makes two contacts whichever body carries the edge") {
  const Mat3 on_edge = turned(half_turn / 4, Vec3::UnitX());
  const double reach = std::sqrt(0.5);
  for (const bool edge_is_first : {true, false}) {
    Scene scene;
    const double gap = 1e-4;
    if (edge_is_first) {
      scene.add(Box{1, 1, 1}, {0.1, 0.2, 0.5 + reach + gap}, on_edge);
      scene.add(Box{4, 4, 1}, {0, 0, 0}, Mat3::Identity());
    } else {
      scene.add(Box{4, 4, 1}, {0, 0, 0}, Mat3::Identity());
      scene.add(Box{1, 1, 1}, {0.1, 0.2, 0.5 + reach + gap}, on_edge);
    }
    scene.detect();
    REQUIRE(scene.contacts.size() == 2);
    for (const ContactPoint& c : scene.contacts) {
      CHECK(c.normal[2] == Approx(edge_is_first ? -1 : 1));
      CHECK(c.gap == Approx(gap).epsilon(1e-6));
      CHECK(std::abs(c.point_a[1] - 0.2) < 1e-9);
      CHECK(std::abs(std::abs(c.point_a[0] - 0.1) - 0.5) < 1e-9);
    }
  }
}

TEST_CASE("crossing edges meet in one point near the crossing") {
  Scene scene;
  const Mat3 roof = turned(half_turn / 4, Vec3::UnitX());
  scene.add(Box{2, 1, 1}, {0, 0, 0}, roof, false);
  scene.add(Box{1, 2, 1}, {0.1, 0.2, 2 * std::sqrt(0.5) - 1e-4}, turned(half_turn / 4, Vec3::UnitY()));
  scene.detect();
  REQUIRE(!scene.contacts.empty());
  double deepest = 1;
  for (const ContactPoint& c : scene.contacts) {
    CHECK((c.point_a.head<2>() - Eigen::Vector2d(0.1, 0)).norm() < 0.3);
    CHECK((c.normal - Vec3::UnitZ()).norm() < 1e-9);
    deepest = std::min(deepest, c.gap);
  }
  CHECK(std::abs(deepest + 1e-4) < 2e-7);  // a side counts as 1e-7 of the scale further out, on a slope of 1
}

// A tilt of θ moves a corner at most θ · 1.5 sizes, so 1e-3 rad may move it 1.5e-3; at 1e-9 and at exact
// alignment the set of points must be the same to 1e-3 of the scale, which is what merges corners.
TEST_CASE("contacts do not jump for tiny tilts") {
  const ConvexHull cube = cube_hull();
  for (const Shape& body : {Shape(Box{1, 1, 1}), Shape(cube), Shape(Cylinder{0.5, 1})})
    for (const Shape& base : {Shape(Box{1, 1, 1}), Shape(cube), Shape(Cylinder{0.5, 1}), Shape(Box{4, 4, 1})})
      for (const double gap : {0.0, 1e-4, -1e-4})
        for (const Vec3& axis : {Vec3(1, 0, 0), Vec3(0.3, 1, 0), Vec3(0, 0, 1), Vec3(1, 1, 1)}) {
          std::vector<std::vector<ContactPoint>> seen;
          for (const double tilt : {0.0, 1e-15, 1e-12, 1e-9, 1e-6, 1e-3}) {
            Scene scene;
            scene.collision.max_points = 8;
            scene.collision.margin = 0.01;
            scene.add(base, {0, 0, 0}, Mat3::Identity(), false);
            scene.add(body, {0, 0, 1 + gap}, turned(tilt, axis));
            scene.detect();
            CAPTURE(name(body.kind), name(base.kind), gap, tilt, axis.transpose());
            REQUIRE(scene.contacts.size() >= 4);
            CHECK((scene.contacts[0].normal - Vec3::UnitZ()).norm() <= 1.1 * tilt + 1e-12);
            seen.push_back(scene.contacts);
            for (const ContactPoint& c : seen.front()) {
              double nearest = 1;
              for (const ContactPoint& d : scene.contacts)
                nearest = std::min(nearest, (c.point_a - d.point_a).norm());
              CHECK(nearest <= 1e-3 + 1.5 * tilt);
            }
          }
        }
}

}  // namespace manifold_tests
