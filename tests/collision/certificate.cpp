#include "catch.hpp"
#include "collision/samples.hpp"

#include <delassus/collision/certificate.hpp>
#include <delassus/collision/gjk_epa.hpp>

#include <limits>
#include <vector>

namespace certificate_tests {

using namespace delassus;
using namespace samples;

namespace {

struct Scene {
  Sample s{Box{1, 1, 1}, Box{1, 1, 1}, {.position = {0.1, 0.2, 0.99}}};
  SignedPair good;
  Scene() {
    PairCache cache;
    good = GjkEpa{}.pair(s.a, s.b, s.b_in_a, 1, cache);
  }
  bool accepts(SignedPair r) const { return certify(s.a, s.b, s.b_in_a, 1, 0.5, r); }
};

}  // namespace

TEST_CASE("a right answer is accepted and its witnesses made exact") {
  Scene scene;
  SignedPair r = scene.good;
  r.point_a += Vec3(1e-3, 0, 1e-3);  // along n the witnesses are rebuilt
  REQUIRE(certify(scene.s.a, scene.s.b, scene.s.b_in_a, 1, 0.5, r));
  CHECK((r.point_b - r.point_a - r.distance * r.normal).norm() < 1e-15);
  CHECK(r.distance == Approx(-0.01).epsilon(1e-12));
}

TEST_CASE("garbage is refused") {
  const Scene scene;
  const double nan = std::numeric_limits<double>::quiet_NaN();
  CHECK(scene.accepts(scene.good));
  SignedPair r = scene.good;
  r.normal *= 1.001;
  CHECK_FALSE(scene.accepts(r));
  r.normal = Vec3::Zero();
  CHECK_FALSE(scene.accepts(r));
  r.normal = Vec3::UnitX();
  CHECK_FALSE(scene.accepts(r));  // depth 0.01 along x is a lie: there it is 0.9
  r.normal = -scene.good.normal;
  CHECK_FALSE(scene.accepts(r));
  r = scene.good;
  r.normal[0] = nan;
  CHECK_FALSE(scene.accepts(r));
  r = scene.good;
  r.distance = nan;
  CHECK_FALSE(scene.accepts(r));
  r.distance = 0.01;
  CHECK_FALSE(scene.accepts(r));
  r = scene.good;
  r.point_b[1] = nan;
  CHECK_FALSE(scene.accepts(r));
  r = scene.good;
  r.status = PairStatus::far;
  CHECK_FALSE(scene.accepts(r));
  CHECK_FALSE(scene.accepts(SignedPair{}));
}

TEST_CASE(
    "a normal that is far from minimal is refused unless its depth is honest, and beaten by a better one") {
  const Scene scene;
  SignedPair sideways{.status = PairStatus::near, .distance = -0.8, .normal = Vec3::UnitY()};
  CHECK(scene.accepts(sideways));  // a valid way out, though not the shortest
  CHECK(is_beaten(scene.s.a, scene.s.b, scene.s.b_in_a, Vec3::UnitZ(), 0.5, sideways));
  CHECK_FALSE(is_beaten(scene.s.a, scene.s.b, scene.s.b_in_a, Vec3::UnitY(), 0.5, scene.good));
  CHECK_FALSE(is_beaten(scene.s.a, scene.s.b, scene.s.b_in_a, Vec3::Zero(), 0.5, sideways));
}

TEST_CASE("the answer of last resort always separates") {
  std::mt19937 random(1);
  const ConvexHull hull = ball_hull(20, 7, 0.5);
  const std::vector<Shape> shapes{Sphere{0.4},         Box{1, 0.6, 0.8}, Capsule{0.25, 0.8},
                                  Cylinder{0.35, 0.8}, hull,             Cone{0.4, 0.9},
                                  Ellipsoid{0.5, 0.3, 0.4}};
  for (const Shape& a : shapes)
    for (const Shape& b : shapes) {
      double apart = 0;
      Sample s = any_pose(a, b, Depth::deep, false, random, apart);
      SignedPair r = coarse_pair(s.a, s.b, s.b_in_a, Vec3::Zero());
      REQUIRE(certify(s.a, s.b, s.b_in_a, 1, 0.4, r));
      s.b_in_a.position -= r.distance * r.normal;
      PairCache cache;
      CHECK(GjkEpa{}.pair(s.a, s.b, s.b_in_a, 10, cache).distance > -1e-7);
    }
}

}  // namespace certificate_tests
