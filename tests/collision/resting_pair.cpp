#include "catch.hpp"
#include "collision/scene.hpp"

#include <cmath>
#include <random>
#include <vector>

namespace resting_pair_tests {

using namespace delassus;
using namespace scenes;

namespace {

/// One body on another, sunk in by 1e-5 m. Both are about 1 m: ε L = 5e-7 m or a little more.
Scene resting(const Shape& below, const Shape& above, bool ground_is_a = true) {
  Scene scene;
  const bool is_plane = below.kind == ShapeKind::half_space;
  scene.add(below, {0, 0, is_plane ? 0 : -0.5}, turned(0.4, Vec3::UnitZ()), false);
  scene.add(above, {0.1, 0.05, 0.5 - 1e-5}, turned(0.1, Vec3::UnitZ()));
  if (!ground_is_a) std::swap(scene.colliders[0].key, scene.colliders[1].key);
  for (int step = 0; step < 3; ++step) scene.detect();
  return scene;
}

void nudge(Collider& body, double size, std::mt19937& random) {
  std::uniform_real_distribution<double> uniform(-1, 1);
  const double x = uniform(random), y = uniform(random), z = uniform(random), u = uniform(random),
               v = uniform(random), w = uniform(random);
  body.pose.position += size * Vec3(x, y, z);
  body.pose.rotation = turned(size, Vec3(u, v, w)) * body.pose.rotation;
}

/// The same step in full: a body that comes fast has a wider margin, and is asked again with all that is
/// remembered.
Scene in_full(Scene scene) {
  scene.colliders[1].velocity = {0, 0, -10};
  scene.detect();
  REQUIRE(scene.report.queries == 1);
  return scene;
}

}  // namespace

// Where a point lies along the faces is older by 1e-6 L; with the tilt of 1e-6 between the faces that is
// 1e-12 in height.
TEST_CASE("what rests is not asked again, and its points, normals and gaps are those of a full answer") {
  const ConvexHull cube = cube_hull();
  for (const Shape& below : {Shape(Box{1, 1, 1}), Shape(cube), Shape(Cylinder{0.5, 1}), Shape(HalfSpace{})})
    for (const Shape& above :
         {Shape(Box{1, 1, 1}), Shape(cube), Shape(Cylinder{0.5, 1}), Shape(Cone{0.5, 2})}) {
      const bool ground_is_a = (int(below.kind) + int(above.kind)) % 2 == 0;
      Scene scene = resting(below, above, ground_is_a);
      CAPTURE(name(below.kind), name(above.kind), ground_is_a);
      if (above.kind == ShapeKind::cone) REQUIRE(scene.contacts.size() >= 4);
      const Pose start = scene.colliders[1].pose;
      std::mt19937 random(3);
      int asked = 0;
      for (int step = 0; step < 60; ++step) {
        scene.colliders[1].pose = start;
        nudge(scene.colliders[1], 1e-7, random);
        const Scene full = in_full(scene);
        scene.detect();
        asked += scene.report.queries;
        REQUIRE(scene.contacts.size() == full.contacts.size());
        for (std::size_t i = 0; i < scene.contacts.size(); ++i) {
          const ContactPoint &p = scene.contacts[i], &q = full.contacts[i];
          CHECK(p.feature == q.feature);
          CHECK((p.point_a - q.point_a).norm() < 1.5e-6);
          CHECK(std::abs(p.gap - q.gap) < 1e-12);
          CHECK((p.normal - q.normal).norm() < 1e-14);
          CHECK((p.point_b - p.point_a - p.gap * p.normal).norm() < 1e-14);
        }
      }
      CHECK(asked == 0);
    }
}

TEST_CASE(
    "who moved by more than a millionth of its size since its patch was cut is asked anew, however slowly") {
  for (const Vec3& way : {Vec3(1, 0, 0), Vec3(0.6, -0.8, 0), Vec3(0, 0, 1)}) {
    Scene scene = resting(Box{1, 1, 1}, Box{1, 1, 1});
    int asked = 0;
    double farthest = 0;
    for (int step = 0; step < 100; ++step) {
      scene.colliders[1].pose.position += 1e-7 * way;
      const Scene full = in_full(scene);
      scene.detect();
      asked += scene.report.queries;
      REQUIRE(scene.contacts.size() == 4);
      for (std::size_t i = 0; i < 4; ++i)
        farthest = std::max(farthest, (scene.contacts[i].point_a - full.contacts[i].point_a).norm());
    }
    // 1e-5 m by steps of 1e-7, asked when 5e-7 are exceeded: at each fifth or sixth step.
    CAPTURE(way.transpose());
    CHECK(asked >= 16);
    CHECK(asked <= 20);
    CHECK(farthest < 6e-7);
  }
  Scene tilted = resting(Box{1, 1, 1}, Box{1, 1, 1});
  tilted.colliders[1].pose.rotation = turned(3e-6, Vec3::UnitX()) * tilted.colliders[1].pose.rotation;
  tilted.detect();
  CHECK(tilted.report.queries == 1);
}

TEST_CASE("another body under the same name, or one that comes faster, is asked anew") {
  const auto asked = [](const auto& change) {
    Scene scene = resting(Box{1, 1, 1}, Box{1, 1, 1});
    change(scene.colliders[1]);
    scene.detect();
    return scene.report.queries;
  };
  CHECK(asked([](Collider&) {}) == 0);
  CHECK(asked([](Collider& c) { c.shape = Cylinder{0.5, 1}; }) == 1);
  CHECK(asked([](Collider& c) { c.shape = Box{1.1, 1, 1}; }) == 1);
  CHECK(asked([](Collider& c) { c.velocity = {0, 0, -10}; }) == 1);  // 1 cm a step: the margin is wider
  CHECK(asked([](Collider& c) { c.pose.position[2] = 0.6; }) == 0);  // its box is gone: no pair
  CHECK(asked([](Collider& c) { c.pose.position[2] = 0.501; }) == 1);
  const ConvexHull one = cube_hull(), other = cube_hull(1.0);
  Scene scene = resting(one, other);
  scene.colliders[1].shape = one;  // the same body elsewhere in memory
  scene.detect();
  CHECK(scene.report.queries == 0);
}

TEST_CASE("a thickness of contact is kept through rest") {
  Scene scene;
  scene.collision.contact_distance = 0.1;
  scene.add(Box{1, 1, 1}, {0, 0, 0}, Mat3::Identity(), false);
  scene.add(Box{1, 1, 1}, {0.1, 0, 1.1 - 1e-5});
  for (int step = 0; step < 4; ++step) scene.detect();
  CHECK(scene.report.queries == 0);
  REQUIRE(scene.contacts.size() == 4);
  for (const ContactPoint& c : scene.contacts) {
    CHECK(std::abs(c.gap + 1e-5) < 1e-14);
    CHECK((c.point_b - c.point_a - c.gap * c.normal).norm() < 1e-14);
  }
}

TEST_CASE("another hull in the place of one that was rested on is noticed, and so is another number of points") {
  const auto plate = [](double narrow) {
    std::vector<Vec3> corners;
    for (const double z : {-0.0625, 0.0625}) {
      for (const double x : {-2., 2.}) corners.push_back({x, 0, z});
      for (const double x : {-1., 1.})
        for (const double y : {-narrow, narrow}) corners.push_back({x, y, z});
    }
    return ConvexHull(corners).centred();
  };
  const ConvexHull wide = plate(0.75), thin = plate(0.375);
  Scene scene;
  scene.add(wide, {0, 0, -0.0625}, Mat3::Identity(), false);
  scene.add(Box{0.06, 0.06, 0.06}, {1.6, 0.23, 0.03 - 1e-6});
  for (int step = 0; step < 3; ++step) scene.detect();
  REQUIRE(scene.contacts.size() == 4);
  scene.colliders[0].shape = thin;
  scene.detect();
  CHECK(scene.contacts.empty());

  Scene fewer = resting(HalfSpace{}, Box{1, 1, 1});
  REQUIRE(fewer.contacts.size() == 4);
  fewer.collision.max_points = 1;
  fewer.detect();
  CHECK(fewer.contacts.size() == 1);
}

TEST_CASE("pairs go on resting while others part and meet") {
  Scene scene;
  for (int i = 0; i < 3; ++i) {
    scene.add(Box{1, 1, 1}, {2.0 * i, 0, 0}, Mat3::Identity(), false);
    scene.add(Box{1, 1, 1}, {2.0 * i + 0.1, 0, 1 - 1e-5});
  }
  for (int step = 0; step < 3; ++step) scene.detect();
  const std::vector<ContactPoint> start = scene.contacts;
  REQUIRE(start.size() == 12);
  const auto is_kept = [&](std::size_t of, std::size_t at) {
    bool is_same = true;
    for (std::size_t k = 0; k < 4; ++k)
      is_same = is_same && start[of + k].pair == scene.contacts[at + k].pair &&
                start[of + k].feature == scene.contacts[at + k].feature &&
                (start[of + k].point_a - scene.contacts[at + k].point_a).norm() < 1e-12;
    return is_same;
  };
  scene.colliders[3].pose.position[2] += 0.02;
  scene.detect();
  CHECK(scene.report.queries == 0);
  REQUIRE(scene.contacts.size() == 8);
  CHECK(is_kept(0, 0));
  CHECK(is_kept(8, 4));
  scene.colliders[3].pose.position[2] -= 0.02;
  scene.detect();
  CHECK(scene.report.queries == 1);
  REQUIRE(scene.contacts.size() == 12);
  CHECK(is_kept(0, 0));
  CHECK(is_kept(8, 8));
}

}  // namespace resting_pair_tests
