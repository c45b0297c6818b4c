#include "catch.hpp"
#include "collision/samples.hpp"
#include "collision/scene.hpp"

#include <delassus/collision/inner/one_point.hpp>

#include <bit>
#include <cmath>
#include <cstdint>
#include <random>
#include <vector>

namespace one_point_tests {

using namespace delassus;
using namespace scenes;

namespace {

bool are_same_bits(double x, double y) {
  return std::bit_cast<std::uint64_t>(x) == std::bit_cast<std::uint64_t>(y);
}
bool are_same_bits(const Vec3& x, const Vec3& y) {
  return are_same_bits(x[0], y[0]) && are_same_bits(x[1], y[1]) && are_same_bits(x[2], y[2]);
}
bool are_same(const ContactPoint& x, const ContactPoint& y) {
  return x.pair == y.pair && x.feature == y.feature && are_same_bits(x.gap, y.gap) &&
         are_same_bits(x.normal, y.normal) && are_same_bits(x.point_a, y.point_a) &&
         are_same_bits(x.point_b, y.point_b) && are_same_bits(x.travel, y.travel);
}

/// The native kernel under another name, which the engine asks for every pair in full.
struct InFull : GjkEpa {};
using SceneInFull = SceneOf<NativeDetection<InFull, BoxTree>>;

/// Forty balls and capsules among half-spaces; some capsules are parallel.
void add_round(auto& scene, std::mt19937& random, int count_of_balls) {
  std::uniform_real_distribution<double> uniform(-1, 1);
  scene.add(HalfSpace{}, {0, 0, -0.5}, samples::any_rotation(random), false);
  for (int i = 0; i < 40; ++i) {
    const Vec3 at(uniform(random), uniform(random), uniform(random));
    const double radius = 0.2 + 0.1 * uniform(random);
    const Shape shape = i < count_of_balls ? Shape(Sphere{radius}) : Shape(Capsule{0.5 * radius, 0.5});
    scene.add(shape, at, i % 5 == 0 ? Mat3(Mat3::Identity()) : samples::any_rotation(random));
  }
  scene.add(HalfSpace{{0, 1, 1}, 0.3}, {0, 0, -1}, Mat3::Identity(), false);  // its key is the larger one
}
void move(auto& scene, std::mt19937& random) {
  std::uniform_real_distribution<double> uniform(-1, 1);
  for (Collider& c : scene.colliders) {
    if (!c.is_movable) continue;
    c.velocity = 3 * Vec3(uniform(random), uniform(random), uniform(random));
    c.angular_velocity = Vec3(uniform(random), uniform(random), uniform(random));
    c.goes_alone = uniform(random) > -0.5;
    c.pose.position += 0.01 * c.velocity;
    c.pose.rotation = turned(0.01, Vec3(c.angular_velocity)) * c.pose.rotation;
  }
}

}  // namespace

TEST_CASE("balls and capsules have the answers of a detection in full bit by bit") {
  for (const int balls : {40, 20, 0})
    for (const bool looks_ahead : {false, true})
      for (unsigned seed = 0; seed < 5; ++seed) {
        std::mt19937 random(seed), again(seed);
        Scene scene;
        SceneInFull full;
        add_round(scene, random, balls), add_round(full, again, balls);
        std::size_t count = 0;
        for (int step = 0; step < 30; ++step) {
          move(scene, random), move(full, again);
          std::vector<ContactPoint> missed, missed_in_full;
          if (looks_ahead) {
            std::set<std::uint64_t> pushed;
            for (const ContactPoint& p : scene.contacts)
              if (p.pair % 3 != 0) pushed.insert(p.pair);
            scene.detect_ahead(0.01, pushed), full.detect_ahead(0.01, pushed);
            for (std::size_t i = 0; i < scene.colliders.size(); i += 2)
              scene.colliders[i].velocity *= -4, full.colliders[i].velocity *= -4;
            missed = scene.missed(0.01, pushed), missed_in_full = full.missed(0.01, pushed);
          } else {
            scene.detect(0.01), full.detect(0.01);
          }
          REQUIRE(scene.contacts.size() == full.contacts.size());
          REQUIRE(missed.size() == missed_in_full.size());
          for (std::size_t i = 0; i < missed.size(); ++i) REQUIRE(are_same(missed[i], missed_in_full[i]));
          for (std::size_t i = 0; i < scene.contacts.size(); ++i)
            REQUIRE(are_same(scene.contacts[i], full.contacts[i]));
          CHECK(scene.report.pairs == full.report.pairs);
          CHECK(scene.report.queries == full.report.queries);
          count += scene.contacts.size() + missed.size();
        }
        CHECK(count > 1000);
      }
}

TEST_CASE("a body that becomes a ball, or is one no more, keeps the names of its contacts") {
  Scene scene;
  SceneInFull full;
  const auto both = [&](const auto& f) { f(scene), f(full); };
  both([](auto& s) {
    s.add(HalfSpace{}, {0, 0, 0}, Mat3::Identity(), false);
    s.add(Sphere{0.5}, {0, 0, 0.4999});
    s.add(Sphere{0.5}, {0.01, 0, 1.4998});
  });
  const Shape shapes[] = {Sphere{0.5},  Ellipsoid{0.5, 0.6, 0.5}, Box{1, 1, 1}, Sphere{0.5}, Sphere{0.5},
                          Box{1, 1, 1}, Cylinder{0.5, 1},         Sphere{0.5}};
  int named = 0;
  for (const Shape& shape : shapes)
    for (const Vec3& at : {Vec3(0, 0, 0.4999), Vec3(0.5, 0.5, 0.4999)}) {
      both([&](auto& s) { s.colliders[1].shape = shape, s.colliders[1].pose.position = at, s.detect(); });
      REQUIRE(scene.contacts.size() == full.contacts.size());
      for (std::size_t i = 0; i < scene.contacts.size(); ++i) {
        REQUIRE(are_same(scene.contacts[i], full.contacts[i]));
        named += scene.contacts[i].feature != 0;
      }
    }
  CHECK(named > 0);
}

TEST_CASE("two balls in one point and balls that are no numbers are left to the general answer") {
  SignedPair r;
  const Shape ball = Sphere{1};
  CHECK_FALSE(inner::one_point(ball, ball, Pose{}, 1, 1, r));
  CHECK_FALSE(inner::one_point(ball, ball, Pose{.position = {std::nan(""), 0, 0}}, 1, 1, r));
  CHECK_FALSE(inner::one_point(Shape(HalfSpace{}), ball, Pose{.position = {0, 0, std::nan("")}}, 1, 1, r));
  REQUIRE(inner::one_point(ball, ball, Pose{.position = {0, 0, 1.5}}, 1, 1, r));
  CHECK(r.distance == -0.5);
}

TEST_CASE("who does not come near by the balls about both is not met") {
  std::mt19937 random(5);
  std::uniform_real_distribution<double> uniform(-1, 1);
  const double h = 0.1;
  int left_out = 0, met = 0;
  for (int i = 0; i < 4000; ++i) {
    const auto any = [&](double size) {
      return Vec3(size * uniform(random), size * uniform(random), size * uniform(random));
    };
    const Shape shapes[] = {Sphere{0.2}, Capsule{0.1, 0.4}, Box{0.3, 0.2, 0.4}, HalfSpace{}};
    const int first = i % 4;
    Collider a{.shape = shapes[first],
               .pose = {any(1), samples::any_rotation(random)},
               .velocity = any(8),
               .angular_velocity = any(4),
               .key = 0};
    if (first == 3 && i % 8 == 3) a.angular_velocity = Vec3::Zero();
    const Collider b{.shape = shapes[i / 4 % 3],
                     .pose = {any(1), samples::any_rotation(random)},
                     .velocity = any(8),
                     .angular_velocity = any(4),
                     .key = 1};
    const double target = 1e-4 * 0.2;
    const bool may = inner::may_come_near(a, b, h, target);
    const inner::Impact hit = inner::time_of_impact(a, b, h, 0.2, target);
    if (hit.is_found || hit.is_now) CHECK(may);
    left_out += !may, met += hit.is_found;
  }
  CHECK(left_out > 500);
  CHECK(met > 100);
}

}  // namespace one_point_tests
