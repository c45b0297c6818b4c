#include "catch.hpp"
#include "collision/samples.hpp"
#include "collision/scene.hpp"

#include <delassus/collision/native_engine.hpp>

#include <cmath>
#include <cstring>
#include <limits>
#include <random>
#include <set>
#include <vector>

namespace engine_tests {

using namespace delassus;
using namespace scenes;

namespace {

/// Bodies of all kinds thrown together.
void fill(Scene& scene, const ConvexHull& hull, int count, unsigned seed) {
  std::mt19937 random(seed);
  std::uniform_real_distribution<double> uniform(-1, 1);
  scene.add(HalfSpace{}, {0, 0, -1}, Mat3::Identity(), false);
  const std::vector<Shape> shapes{Sphere{0.4},         Box{1, 0.6, 0.8}, Capsule{0.25, 0.8},
                                  Cylinder{0.35, 0.8}, hull,             Cone{0.4, 0.9},
                                  Ellipsoid{0.5, 0.3, 0.4}};
  for (int i = 0; i < count; ++i) {
    const Vec3 position = 1.5 * Vec3{uniform(random), uniform(random), uniform(random)};
    scene.add(shapes[std::size_t(i) % shapes.size()], position, samples::any_rotation(random), i % 7 != 0);
  }
}

bool same_bits(const std::vector<ContactPoint>& a, const std::vector<ContactPoint>& b) {
  if (a.size() != b.size()) return false;
  for (std::size_t i = 0; i < a.size(); ++i)
    if (a[i].pair != b[i].pair || a[i].feature != b[i].feature || a[i].gap != b[i].gap ||
        a[i].normal != b[i].normal || a[i].point_a != b[i].point_a || a[i].point_b != b[i].point_b)
      return false;
  return true;
}

}  // namespace

TEST_CASE("contacts come sorted by pair and feature, from the lower key to the higher, each name once") {
  Scene scene;
  const ConvexHull hull = samples::ball_hull(20, 7, 0.5);
  fill(scene, hull, 40, 1);
  for (Collider& c : scene.colliders)
    c.key = 1000 - 7 * c.key;  // keys need not follow the order of the array
  for (int step = 0; step < 3; ++step) scene.detect();
  REQUIRE(scene.contacts.size() > 50);
  for (std::size_t i = 0; i < scene.contacts.size(); ++i) {
    const ContactPoint& c = scene.contacts[i];
    const Collider &a = scene.colliders[c.a], &b = scene.colliders[c.b];
    CHECK(a.key < b.key);
    CHECK(c.pair == (std::uint64_t(a.key) << 32 | b.key));
    CHECK((a.is_movable || b.is_movable));
    CHECK(std::abs(c.normal.norm() - 1) < 1e-12);
    CHECK((c.point_b - c.point_a - c.gap * c.normal).norm() < 1e-13);
    if (i == 0) continue;
    const ContactPoint& before = scene.contacts[i - 1];
    CHECK((before.pair < c.pair || (before.pair == c.pair && before.feature < c.feature)));
  }
  CHECK(scene.report.points == Index(scene.contacts.size()));
  CHECK(scene.report.rejects == 0);
}

TEST_CASE("the same scene gives the same bits, also when the colliders are listed in another order") {
  const ConvexHull hull = samples::ball_hull(20, 7, 0.5);
  Scene first, second, shuffled;
  fill(first, hull, 40, 2);
  fill(second, hull, 40, 2);
  fill(shuffled, hull, 40, 2);
  std::reverse(shuffled.colliders.begin(), shuffled.colliders.end());
  for (int step = 0; step < 3; ++step) {
    first.detect();
    second.detect();
    shuffled.detect();
    CHECK(same_bits(first.contacts, second.contacts));
    CHECK(same_bits(first.contacts, shuffled.contacts));
  }
}

TEST_CASE("groups and masks decide who meets whom, both ways") {
  const auto contacts = [](std::uint32_t group_a, std::uint32_t mask_a, std::uint32_t group_b,
                           std::uint32_t mask_b) {
    Scene scene;
    scene.add(Sphere{1}, {0, 0, 0});
    scene.add(Sphere{1}, {1, 0, 0});
    scene.colliders[0].group = group_a, scene.colliders[0].collides_with = mask_a;
    scene.colliders[1].group = group_b, scene.colliders[1].collides_with = mask_b;
    scene.detect();
    return scene.contacts.size();
  };
  CHECK(contacts(1, ~0u, 1, ~0u) == 1);
  CHECK(contacts(1, 2, 2, 1) == 1);
  CHECK(contacts(1, 1, 2, ~0u) == 0);
  CHECK(contacts(1, ~0u, 2, 2) == 0);
}

TEST_CASE("two bodies that do not move, and bodies without a shape, make no contacts") {
  Scene scene;
  scene.add(Box{1, 1, 1}, {0, 0, 0}, Mat3::Identity(), false);
  scene.add(Box{1, 1, 1}, {0.5, 0, 0}, Mat3::Identity(), false);
  scene.add(HalfSpace{}, {0, 0, 0}, Mat3::Identity(), false);
  scene.add(Shape{}, {0, 0, 0});
  scene.detect();
  CHECK(scene.contacts.empty());
  CHECK(scene.report.queries == 0);
}

TEST_CASE("a body that is not finite is left out and harms nobody") {
  Scene scene;
  scene.add(HalfSpace{}, {0, 0, 0}, Mat3::Identity(), false);
  for (int i = 0; i < 20; ++i) scene.add(Sphere{0.5}, {1.1 * i, 0, 0.5});
  scene.colliders[5].pose.position[1] = std::numeric_limits<double>::quiet_NaN();
  scene.colliders[9].velocity[0] = std::numeric_limits<double>::infinity();
  scene.colliders[13].pose.rotation(0, 0) = std::numeric_limits<double>::quiet_NaN();
  scene.detect();
  for (const ContactPoint& c : scene.contacts) CHECK(std::isfinite(c.gap));
  CHECK(scene.contacts.size() >= 17);
}

TEST_CASE("the margin decides when a contact begins, and never what its gap is") {
  for (const double gap : {0.004, 0.02, 0.2}) {
    const auto contacts = [&](double margin, double speed) {
      Scene scene;
      scene.collision.margin = margin;
      scene.add(Box{1, 1, 1}, {0, 0, 0}, Mat3::Identity(), false);
      scene.add(Box{1, 1, 1}, {0, 0, 1 + gap});
      scene.colliders[1].velocity = {0, 0, -speed};
      scene.detect(0.01);
      for (const ContactPoint& c : scene.contacts) CHECK(c.gap == Approx(gap).epsilon(1e-12));
      return scene.contacts.size();
    };
    CHECK(contacts(0.99 * gap, 0) == 0);
    CHECK(contacts(1.01 * gap, 0) == 4);
    // Automatic: max(5e-3 L, |v| h), at most L/2, with L = 1/2.
    CHECK(contacts(-1, 0.0) == (gap < 0.0025 ? 4u : 0u));
    CHECK(contacts(-1, 1.01 * gap / 0.01) == 4);
    CHECK(contacts(-1, 0.99 * gap / 0.01) == 0);
  }
}

TEST_CASE("the contact distance is a thickness: it shifts the gap and both witnesses") {
  Scene scene;
  scene.collision.contact_distance = 0.1;
  scene.add(Sphere{1}, {0, 0, 0});
  scene.add(Sphere{1}, {0, 0, 2.05});
  scene.detect();
  REQUIRE(scene.contacts.size() == 1);
  const ContactPoint& c = scene.contacts[0];
  CHECK(c.gap == Approx(-0.05).epsilon(1e-12));
  CHECK((c.point_b - c.point_a - c.gap * c.normal).norm() < 1e-14);
}

TEST_CASE("no fast body slips through the boxes: broad phase and margin agree") {
  // The widest margin a pair can have must be covered by its two alarm boxes, whatever their sizes and
  // speeds.
  std::mt19937 random(12);
  std::uniform_real_distribution<double> uniform(0, 1);
  for (int k = 0; k < 500; ++k) {
    const double small = 0.01 + uniform(random), big = small * (1 + 20 * uniform(random)), h = 0.01;
    Collider a{.shape = Sphere{small}}, b{.shape = Sphere{big}};
    a.velocity = 300 * uniform(random) * uniform(random) * Vec3::UnitX();
    b.velocity = -300 * uniform(random) * uniform(random) * Vec3::UnitX();
    const CollisionSettings settings;
    const double margin = inner::widest_margin(inner::top_speed(a) + inner::top_speed(b), std::min(small, big), h, settings);
    b.pose.position = (small + big + 0.999999 * margin) * Vec3::UnitX();
    const auto box = [&](const Collider& c) {
      return inner::alarm_box(c, inner::summary_of(c), h, settings);
    };
    CHECK(box(a).intersects(box(b)));
  }
}

TEST_CASE("points keep their names while a box slides, and a new box does not take them") {
  const ConvexHull cube = cube_hull();
  for (const Shape& floor :
       {Shape(Box{20, 20, 1}), Shape(HalfSpace{{0, 0, 1}, 0.5}), Shape(Box{1.1, 1.1, 1})})
    for (const Shape& body : {Shape(Box{1, 1, 1}), Shape(cube), Shape(Cylinder{0.5, 1})}) {
      Scene scene;
      scene.add(floor, {0, 0, 0}, Mat3::Identity(), false);
      scene.add(body, {-0.2, 0, 1}, turned(0.2, Vec3::UnitZ()));
      std::set<std::uint32_t> before;
      int kept = 0, total = 0;
      for (int step = 0; step < 200; ++step) {
        // 1 mm a step with the noise of a resting contact: 1e-6 rad of tilt, 1e-5 m of depth.
        scene.colliders[1].pose.position += Vec3(1e-3, 3e-4, 0);
        scene.colliders[1].pose.position[2] = 1 + 1e-5 * std::sin(7.0 * step);
        scene.colliders[1].pose.rotation =
            turned(1e-6 * std::sin(5.0 * step), Vec3(1, 0.3, 0)) * turned(0.2, Vec3::UnitZ());
        scene.detect();
        std::set<std::uint32_t> now;
        for (const ContactPoint& c : scene.contacts) now.insert(c.feature);
        REQUIRE(now.size() == scene.contacts.size());
        if (step > 0)
          for (const std::uint32_t f : now) ++total, kept += before.count(f) > 0;
        before = now;
      }
      CAPTURE(name(floor.kind), name(body.kind), kept, total);
      CHECK(kept >= 0.95 * total);
      CHECK(total >= 4 * 199);
    }
}

TEST_CASE("points keep their names on an equal box, where every corner of the patch is a corner of both") {
  // A shift of 1e-5 either way makes the corner of the patch one of A's, one of B's or a crossing: the raw
  // names change, the place does not.
  Scene scene;
  scene.add(Box{1, 1, 1}, {0, 0, 0}, Mat3::Identity(), false);
  scene.add(Box{1, 1, 1}, {0, 0, 1});
  scene.detect();
  const std::vector<ContactPoint> first = scene.contacts;
  REQUIRE(first.size() == 4);
  for (int step = 0; step < 50; ++step) {
    scene.colliders[1].pose.position = Vec3(1e-5 * std::sin(3.0 * step), 1e-5 * std::cos(5.0 * step), 1);
    scene.detect();
    REQUIRE(scene.contacts.size() == 4);
    for (std::size_t i = 0; i < 4; ++i) {
      CHECK(scene.contacts[i].feature == first[i].feature);
      CHECK((scene.contacts[i].point_a - first[i].point_a).norm() < 3e-5);
    }
  }
}

TEST_CASE("what is remembered only names points: without it the places and gaps are the same") {
  const ConvexHull hull = samples::ball_hull(20, 7, 0.5);
  Scene scene, fresh;
  fill(scene, hull, 30, 5);
  fresh.colliders = scene.colliders;
  scene.collision.max_points = fresh.collision.max_points = 8;
  for (int step = 0; step < 3; ++step) scene.detect();
  fresh.detect();
  REQUIRE(scene.contacts.size() == fresh.contacts.size());
  for (std::size_t i = 0; i < scene.contacts.size(); ++i)
    CHECK(scene.contacts[i].pair == fresh.contacts[i].pair);
}

TEST_CASE("far from the origin contacts keep the digits the coordinates have") {
  for (const double far : {1e3, 1e6}) {
    Scene scene;
    scene.add(Box{4, 4, 1}, {far, -far, far}, Mat3::Identity(), false);
    scene.add(Box{1, 1, 1}, {far + 0.1, -far, far + 1 - 1e-4});
    scene.detect();
    REQUIRE(scene.contacts.size() == 4);
    for (const ContactPoint& c : scene.contacts) {
      CHECK((c.normal - Vec3::UnitZ()).norm() < 1e-12);
      CHECK(std::abs(c.gap + 1e-4) < 4e-16 * far + 1e-12);
    }
  }
}

}  // namespace engine_tests
