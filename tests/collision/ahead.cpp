#include "catch.hpp"
#include "collision/mesh_scene.hpp"
#include "collision/scene.hpp"

#include <delassus/collision/with_compounds.hpp>

#include <cmath>

namespace ahead_tests {

using namespace delassus;
using namespace scenes;

namespace {

constexpr double h = 1.0 / 60;

/// A box of 1 m about the origin, and a ball beside its face x = 0.5 that comes down along it.
Collider& ball_beside_edge(Scene& scene, double radius, double clearance, double height, const Vec3& velocity) {
  scene.add(Box{1, 1, 1}, {0, 0, 0}, Mat3::Identity(), false);
  Collider& ball = scene.add(Sphere{radius}, {0.5 + radius + clearance, 0, height});
  ball.velocity = velocity;
  return ball;
}

}  // namespace

TEST_CASE("a pair that passes an edge has no contact, where it had one before anybody asked") {
  Scene scene;
  ball_beside_edge(scene, 0.01, 1e-3, 0.507, {0, 0, -3});
  scene.detect(h);
  CHECK(scene.contacts.size() == 1);
  scene.detect_ahead(h);
  CHECK(scene.contacts.empty());
  CHECK(scene.missed(h).empty());
}

TEST_CASE("a pair that pushed, touches, or has a partner whose motion is not known keeps its contact") {
  Scene scene;
  Collider& ball = ball_beside_edge(scene, 0.01, 1e-3, 0.507, {0, 0, -3});
  scene.detect_ahead(h, {pair_key(0, 1)});
  CHECK(scene.contacts.size() == 1);
  ball.goes_alone = false;
  scene.detect_ahead(h);
  CHECK(scene.contacts.size() == 1);
  ball.goes_alone = true;
  ball.pose.position = {0.51 + 5e-7, 0, 0.3};  // nearer than 1e-4 of its size
  ball.velocity = {3, 0, 0};
  scene.detect_ahead(h);
  CHECK(scene.contacts.size() == 1);
}

TEST_CASE("a pair that was left out comes back when its motion turns out to be another") {
  Scene scene;
  Collider& ball = ball_beside_edge(scene, 0.01, 1e-3, 0.2, {0, 0, -0.5});
  scene.detect_ahead(h);
  REQUIRE(scene.contacts.empty());
  ball.velocity = {-1, 0, -0.5};
  const auto back = scene.missed(h);
  REQUIRE(back.size() == 2);  // its surface, and the ball about its middle, which would go farther than its radius
  CHECK((back[0].normal - Vec3(1, 0, 0)).norm() < 1e-12);
  CHECK(std::abs(back[0].gap - 1e-3) < 1e-12);
  CHECK(scene.missed(h).empty());  // once
}

TEST_CASE("a body that becomes faster than its box took into account is looked for in its whole way") {
  Scene scene;
  scene.add(HalfSpace{}, {0, 0, 0}, Mat3::Identity(), false);
  scene.add(Box{0.1, 1, 1}, {3, 0, 0.6}, Mat3::Identity(), false);
  Collider& ball = scene.add(Sphere{0.01}, {0, 0, 0.6});
  scene.detect_ahead(h);
  REQUIRE(scene.contacts.empty());
  CHECK(scene.missed(h).empty());
  ball.velocity = {300, 0, 0};  // 5 m in a step
  const auto wall = scene.missed(h);
  REQUIRE(wall.size() == 2);  // its surface, and the ball about its middle
  for (const ContactPoint& p : wall) CHECK(std::abs(p.normal[0]) == 1);
  ball.velocity = {0, 0, -300};
  const auto floor = scene.missed(h);
  REQUIRE(floor.size() == 2);
  for (const ContactPoint& p : floor) CHECK(p.normal[2] == 1);
}

TEST_CASE("what meets elsewhere than at its nearest points has the row of the place of impact") {
  // A ball of 5 cm that lands 5 mm inside the edge, aslant: its nearest point is on the edge, it meets the face.
  Scene scene;
  const double angle = 0.8;
  const Vec3 direction(std::cos(angle), 0, -std::sin(angle)), lands(0.495, 0, 0.55);
  const double way = 0.04;
  ball_beside_edge(scene, 0.05, 0, 0, Vec3(3 * direction)).pose.position = lands - way * direction;
  scene.detect_ahead(h);
  REQUIRE(scene.contacts.size() >= 1);
  CHECK((scene.contacts[0].normal - Vec3(0, 0, 1)).norm() < 1e-9);
  CHECK(std::abs(scene.contacts[0].gap - way * std::sin(angle)) < 1e-9);
}

TEST_CASE("a ball far from a plate that it will reach in the step has a contact with the way to go") {
  for (const double v : {100.0, 1000.0, 3000.0})
    for (const double start : {0.05, 0.0731, 0.094}) {
      Scene scene;
      scene.add(Box{1, 1, 1e-3}, {0, 0, 0}, Mat3::Identity(), false);
      scene.add(Sphere{0.01}, {0.02, 0.01, start + 0.0105}).velocity = {0.3 * v, 0, -v};
      scene.detect_ahead(1e-3);
      REQUIRE(scene.contacts.size() == 2);  // the ball and the core within
      const ContactPoint &p = scene.contacts[0], &core = scene.contacts[1];
      CHECK(std::abs(core.gap - start - 0.005) < 1e-5);  // 1e-3 of the core's radius early
      CHECK(std::abs(p.gap - start) < 1e-9);
      CHECK((p.normal - Vec3(0, 0, 1)).norm() < 1e-12);
      CHECK((p.point_b - p.point_a - p.gap * p.normal).norm() < 1e-12);
      for (const ContactPoint& c : scene.contacts)  // no impulse along the normal turns it
        CHECK((c.point() + 0.5 * c.travel - scene.colliders[1].pose.position).cross(c.normal).norm() < 1e-9);
    }
}

TEST_CASE("who does not arrive in the step, or may not meet, has no contact") {
  Scene scene;
  scene.add(Box{1, 1, 1e-3}, {0, 0, 0}, Mat3::Identity(), false);
  Collider& ball = scene.add(Sphere{0.01}, {0, 0, 0.2});
  for (const Vec3& v : {Vec3(0, 0, -150), Vec3(0, 0, 1000), Vec3(1000, 0, 0), Vec3(1000, 0, -200)}) {
    ball.velocity = v;
    scene.detect_ahead(1e-3);
    CHECK(scene.contacts.empty());
  }
  ball.velocity = {0, 0, -1000};
  ball.group = 2;
  scene.colliders[0].collides_with = 1;
  scene.detect_ahead(1e-3);
  CHECK(scene.contacts.empty());
}

TEST_CASE("a rod that turns by two radians in a step meets a thin pin where geometry says") {
  // Rod along x of radius 5 mm about the origin, pin of 2 mm along z at the angle of 1 rad and 0.8 m: the
  // axes are 7 mm apart when the rod has turned to 1 rad − asin(0.007 / 0.8).
  const double omega = 400, reach = 0.8, sum = 0.007;
  Scene scene;
  scene.add(Capsule{0.002, 0.4}, {reach * std::cos(1), reach * std::sin(1), 0}, Mat3::Identity(), false);
  const Mat3 along_x = Eigen::AngleAxisd(1.5707963267948966, Vec3(0, 1, 0)).toRotationMatrix();
  scene.add(Capsule{0.005, 2}, {0, 0, 0}, along_x).angular_velocity = {0, 0, omega};
  scene.detect_ahead(5e-3);
  REQUIRE(scene.contacts.size() == 1);
  const ContactPoint& p = scene.contacts[0];
  const Vec3 u = Vec3(0, 0, 1).cross(p.point());  // of the rod's point, for 1 rad/s
  // The row u⁺ + gap / h ≥ 0 lets it turn by gap / (−n · u). It ends 1e-4 of 4 mm early, and the way that is left is taken
  // along a normal which the turn still changes.
  const double angle = p.gap / -p.normal.dot(u), expected = 1 - std::asin(sum / reach);
  CHECK(std::abs(angle - expected) < 1e-5);
}

TEST_CASE("parts of compounds and triangles are left out by themselves") {
  SceneOf<WithCompounds<NativeCollision>> parts;
  const Shape cube = parts.collision.add(Compound(std::vector<CompoundPart>{{.shape = Box{1, 1, 0.5}, .position = {0, 0, -0.25}},
                                                                            {.shape = Box{1, 1, 0.5}, .position = {0, 0, 0.25}}}));
  MeshScene mesh;
  const auto check = [](auto& scene, const Shape& shape) {
    scene.add(shape, {0, 0, 0}, Mat3::Identity(), false);
    Collider& ball = scene.add(Sphere{0.01}, {0.511, 0.013, 0.4});
    ball.velocity = {0, 0, -3};
    scene.detect_ahead(h);
    CHECK(scene.contacts.empty());
    CHECK(scene.missed(h).empty());
    ball.velocity = {-1, 0, -3};
    const auto back = scene.missed(h);
    REQUIRE(back.size() >= 1);
    for (const ContactPoint& p : back) CHECK(std::abs(std::abs(p.normal[0]) - 1) < 1e-9);
    ball.pose.position = {0.2, 0.013, 2};
    ball.velocity = {0, 0, -300};
    scene.detect_ahead(h);
    CHECK(scene.contacts.size() >= 1);
  };
  check(parts, cube);
  check(mesh, mesh.collision.add(fine_box(1, 1, 1, 2)));
}

TEST_CASE("a triangle is as far from a box as the nearest corner, whichever corner that is") {
  // A cube of 0.2 m, tilted by 0.1 rad about its middle, comes down on the inside of a triangle and slides over it. Its lowest corner is 5 mm
  // above, and goes down by 9 mm in the step: it meets the triangle after 5/9 of it. The next corners are 0.2 sin(0.1) sin(0.3) = 5.9 mm higher,
  // and more. Each of the four corners is the lowest in turn.
  for (int k = 0; k < 4; ++k)
    for (const double slide : {0.0, 1.0, 6.0}) {
      MeshScene scene;
      const std::vector<Vec3> v{{-2, -2, 0}, {3, -2, 0}, {-2, 3, 0}};
      scene.add(scene.collision.add(TriangleMesh(v, std::vector<Corners>{{0, 1, 2}})), {0, 0, 0}, Mat3::Identity(), false);
      const double head = 0.5 * 3.141592653589793 * k + 0.3;
      const Mat3 tilt = turned(0.1, Vec3(std::cos(head), std::sin(head), 0));
      const double deep = 0.1 * (std::abs(tilt(2, 0)) + std::abs(tilt(2, 1)) + std::abs(tilt(2, 2)));
      scene.add(Box{0.2, 0.2, 0.2}, {0, 0, deep + 5e-3}, tilt).velocity = {slide, 0, -9e-3 / h};
      scene.detect_ahead(h);
      INFO("corner " << k << ", slides at " << slide << " m/s");
      REQUIRE(scene.contacts.size() >= 1);
      double least = 1;
      for (const ContactPoint& p : scene.contacts) least = std::min(least, p.gap);
      CHECK(std::abs(least - 5e-3) < 1e-12);  // sums of lengths below 1 m
    }
}

}  // namespace ahead_tests
