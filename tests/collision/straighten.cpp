#include "catch.hpp"
#include "collision/samples.hpp"

#include <delassus/collision/inner/straighten.hpp>

using namespace delassus;
using namespace samples;

namespace {

/// A normal of the pose that leans by `angle` in some direction, with what it proves.
SignedPair leaning(const Sample& s, const Vec3& n, double angle, std::mt19937& random) {
  const Vec3 across = n.cross(any_direction(random)).normalized();
  SignedPair r{.status = PairStatus::near, .normal = (n + angle * across).normalized()};
  r.distance = -s.reach(r.normal);
  r.point_a = support(s.a, r.normal);
  r.point_b = r.point_a + r.distance * r.normal;
  return r;
}

}  // namespace

TEST_CASE("the normal of round bodies is straightened to 1e-6, apart, nearly touching and overlapping") {
  // Support points one over the other: n is a minimum of h while the depth is less than either radius, 0.05 m
  // at least. GJK sees 2e-16 of a gap of 4e-3 m: √(4e-16 / 4e-3) = 3e-7 rad.
  std::mt19937 random(3);
  const std::vector<Shape> round{Ellipsoid{0.5, 0.3, 0.4}, Ellipsoid{0.3, 0.4, 0.3}, Capsule{0.25, 0.8}};
  for (const double distance : {0.3, 1e-2, 1e-4, 1e-9, 0.0, -1e-6, -1e-3, -2e-2})
    for (int k = 0; k < 60; ++k) {
      const Shape &a = round[std::size_t(k % 2)], &b = round[std::size_t(k % 3)];
      const Mat3 rotation = any_rotation(random);
      const Vec3 n = any_direction(random);
      const Sample s = at_distance(a, b, rotation, n, distance);
      SignedPair r = leaning(s, n, 1e-3, random);
      inner::Straighten{s.a, s.b, s.b_in_a, 0.4}(r, false);
      CAPTURE(distance, k, (r.normal - n).norm());
      CHECK((r.normal - n).norm() < 1e-6);
      CHECK(std::abs(r.distance - distance) < 1e-12);
      CHECK((r.point_b - r.point_a - r.distance * r.normal).norm() < 1e-14);
    }
}

TEST_CASE("a face that meets a point gives its own normal, to the last bit") {
  std::mt19937 random(4);
  for (const double distance : {0.3, 1e-3, 0.0, -1e-3})
    for (int k = 0; k < 20; ++k) {
      const Sample s = at_distance(Box{1, 0.6, 0.8}, Ellipsoid{0.5, 0.3, 0.4}, any_rotation(random),
                                   unit_axis(2), distance);
      // Over the middle of the face.
      Sample over = s;
      over.b_in_a.position[0] -= 0.5, over.b_in_a.position[1] -= 0.3;
      SignedPair r = leaning(over, unit_axis(2), 1e-4, random);
      inner::Straighten{over.a, over.b, over.b_in_a, 0.6}(r, true);
      CHECK(r.normal == unit_axis(2));
      CHECK(std::abs(r.distance - distance) < 1e-15);
    }
}

TEST_CASE("a normal that is none of the minimum's neighbours is left as it is") {
  const Sample s = at_distance(Box{1, 1, 1}, Ellipsoid{0.5, 0.3, 0.4}, Mat3::Identity(), unit_axis(2), -1e-2);
  std::mt19937 random(5);
  const SignedPair before = leaning(s, unit_axis(2), 0.5, random);
  SignedPair r = before;
  inner::Straighten{s.a, s.b, s.b_in_a, 1}(r, true);
  CHECK(r.normal == before.normal);
  CHECK(r.distance == before.distance);
}
