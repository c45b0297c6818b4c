#include "catch.hpp"
#include "collision/scene.hpp"

#include <delassus/collision/continuous.hpp>

#include <cmath>

namespace continuous_tests {

using namespace delassus;
using namespace scenes;

namespace {
using FastScene = SceneOf<Continuous<NativeCollision>>;
}

TEST_CASE("a ball far from a plate that it will reach in the step has a contact with the way to go") {
  for (const double v : {100.0, 1000.0, 3000.0})
    for (const double start : {0.05, 0.0731, 0.094}) {
      FastScene scene;
      scene.add(Box{1, 1, 1e-3}, {0, 0, 0}, Mat3::Identity(), false);
      scene.add(Sphere{0.01}, {0.02, 0.01, start + 0.0105}).velocity = {0.3 * v, 0, -v};
      scene.detect(1e-3);
      REQUIRE(scene.contacts.size() == 2);  // the ball and the core within
      const ContactPoint& p = scene.contacts[0];
      CHECK(std::abs(scene.contacts[1].gap - start - 0.005) < 1e-5);
      // It stops at 1e-3 of 0.01 m before touching, or earlier within the last step of the advancement.
      CHECK(p.gap <= start);
      CHECK(p.gap >= start - 1e-5);
      CHECK((p.normal - Vec3(0, 0, 1)).norm() < 1e-12);
      CHECK((p.point_b - p.point_a - p.gap * p.normal).norm() < 1e-12);
      CHECK((0.5 * (p.point_a + p.point_b) - scene.colliders[1].pose.position).norm() <
            1e-12);  // does not turn it
    }
}

TEST_CASE("who does not arrive in the step, or passes by, has no contact") {
  FastScene scene;
  scene.add(Box{1, 1, 1e-3}, {0, 0, 0}, Mat3::Identity(), false);
  Collider& ball = scene.add(Sphere{0.01}, {0, 0, 0.2});
  for (const Vec3& v : {Vec3(0, 0, -150), Vec3(0, 0, 1000), Vec3(1000, 0, 0), Vec3(1000, 0, -200)}) {
    ball.velocity = v;
    scene.detect(1e-3);
    CHECK(scene.contacts.empty());
  }
  ball.velocity = {0, 0, -1000};
  ball.group = 2;
  scene.colliders[0].collides_with = 1;
  scene.detect(1e-3);
  CHECK(scene.contacts.empty());
}

TEST_CASE("a rod that turns by two radians in a step meets a thin pin where geometry says") {
  // Rod along x of radius 5 mm about the origin, pin of 2 mm along z at the angle of 1 rad and 0.8 m: the
  // axes are 7 mm apart when the rod has turned to 1 rad − asin(0.007 / 0.8).
  const double omega = 400, h = 5e-3, reach = 0.8, sum = 0.007;
  FastScene scene;
  scene.add(Capsule{0.002, 0.4}, {reach * std::cos(1), reach * std::sin(1), 0}, Mat3::Identity(), false);
  const Mat3 along_x = Eigen::AngleAxisd(1.5707963267948966, Vec3(0, 1, 0)).toRotationMatrix();
  scene.add(Capsule{0.005, 2}, {0, 0, 0}, along_x).angular_velocity = {0, 0, omega};
  scene.detect(h);
  REQUIRE(scene.contacts.size() == 1);
  const ContactPoint& p = scene.contacts[0];
  const Vec3 arm = 0.5 * (p.point_a + p.point_b);
  const Vec3 u = Vec3(0, 0, 1).cross(arm);  // of the rod's point, for 1 rad/s
  // p.normal is from the pin (the lower key) to the rod. The row u⁺ + gap / h ≥ 0 lets it turn by gap / (−n ·
  // u).
  const double angle = p.gap / -p.normal.dot(u), expected = 1 - std::asin(sum / reach);
  CHECK(angle <= expected + 1e-9);
  CHECK(angle >=
        expected -
            2e-3);  // 1e-3 of the scale of 0.202 m early, at 0.8 m: 2.5e-4 rad; the step of a look as much
}

TEST_CASE("a turning plank that meets a plate flat is held at all its corners, on a half-space too") {
  for (const bool is_plate : {true, false}) {
    FastScene scene;
    scene.add(is_plate ? Shape(Box{4, 4, 1e-3}) : Shape(HalfSpace{}), {0, 0, is_plate ? -5e-4 : 0.},
              Mat3::Identity(), false);
    // 1 m long beside the axis of its turn at the height 0.1 m; it reaches the plate after a quarter of a
    // turn.
    scene.add(Box{2, 0.02, 0.02}, {0, 0, 0.7}, Mat3::Identity()).angular_velocity = {0, 2000, 0};
    scene.detect(1e-3);
    REQUIRE(scene.contacts.size() == 2);  // the two corners of one end
    for (const ContactPoint& p : scene.contacts) {
      CHECK(std::abs(0.5 * (p.point_a + p.point_b)[0]) > 0.6);
      CHECK(p.gap > 0);
    }
  }
}

TEST_CASE("slow scenes are the backend's to the bit") {
  Scene plain;
  FastScene fast;
  const auto fill = [](auto& scene) {
    scene.add(HalfSpace{}, {0, 0, 0}, Mat3::Identity(), false);
    for (int i = 0; i < 5; ++i) scene.add(Box{1, 1, 1}, {0, 0, 0.5 + 1.001 * i}).velocity = {0, 0, -1};
    scene.detect(1e-3);
  };
  fill(plain);
  fill(fast);
  REQUIRE(plain.contacts.size() == fast.contacts.size());
  for (std::size_t i = 0; i < plain.contacts.size(); ++i)
    CHECK(plain.contacts[i].gap == fast.contacts[i].gap);
  CHECK(plain.report.queries == fast.report.queries);
}

}  // namespace continuous_tests
