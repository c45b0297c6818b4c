#include "catch.hpp"
#include "collision/samples.hpp"

#include <delassus/collision/inner/newton_normal.hpp>

namespace newton_normal_tests {

using namespace delassus;
using namespace samples;

namespace {

/// The pose as B sees A, and a normal as it is there.
Sample swapped(const Sample& s) {
  const Mat3 R = s.b_in_a.rotation;
  return {s.b, s.a, {.position = -(R.transpose() * s.b_in_a.position), .rotation = R.transpose()}};
}

/// Leans n by `angle` and asks for the minimum, from both sides: the larger error, rad.
double error(const Sample& s, const Vec3& n, double angle, std::mt19937& random) {
  const Vec3 lean = (n + angle * n.cross(any_direction(random)).normalized()).normalized();
  const Sample t = swapped(s);
  const Mat3 R = s.b_in_a.rotation;
  const Vec3 here = inner::NewtonNormal{inner::Difference{s.a, s.b, s.b_in_a}}(lean),
             there =
                 -(R * inner::NewtonNormal{inner::Difference{t.a, t.b, t.b_in_a}}(-(R.transpose() * lean)));
  return std::max((here - n).norm(), (there - n).norm());
}

}  // namespace

TEST_CASE("Newton's method finds the normal of smooth bodies whose depth is all but level around it") {
  // Two ellipsoids with n a minimum of h as long as the depth is less than R, the least radius of A − B along
  // n. Balls of 0.3 m, one of them 1e-4 flatter, are 0.599 m deep in one another: K = 1e-3 m and less.
  // Rounding of 2e-16 m then turns n by 1e-12 at most; half of 1e-3 rad of lean is what third derivatives
  // cost at first.
  std::mt19937 random(1);
  const Shape ball = Sphere{0.3}, flat = Ellipsoid{0.3, 0.3, 0.2999};
  for (int k = 0; k < 100; ++k) {
    const Vec3 n = any_direction(random);
    const Sample s = at_distance(flat, ball, any_rotation(random), n, -0.598);
    CAPTURE(k);
    CHECK(error(s, n, 1e-4, random) < 1e-10);
  }
}

TEST_CASE("Newton's method finds the normal across an edge that is straight, or turns with the normal") {
  // The ellipsoid's support point over an edge, nearer to one end, 0.15 m deep: of a box along z, of a cone
  // between the tip and the rim, where the mantle's normal is (height, radius) / slant. The ellipsoid's least
  // radius is 0.3² / 0.5 = 0.18 m, so that n is a minimum, K ≥ 0.03 m. Leans by less than the looks to either
  // side find the edge.
  std::mt19937 random(2);
  std::uniform_real_distribution<double> uniform(0, 2 * M_PI);
  const Shape ellipsoid = Ellipsoid{0.5, 0.3, 0.4};
  for (int k = 0; k < 100; ++k) {
    const double angle = uniform(random), quarter = 0.1 + 0.22 * angle;
    const Vec3 n_box(std::cos(quarter), std::sin(quarter), 0);
    Sample box = at_distance(Box{1, 0.6, 0.8}, ellipsoid, any_rotation(random), n_box, -0.15);
    box.b_in_a.position[2] += 0.2 - support(box.a, n_box)[2];
    CAPTURE(k);
    CHECK(error(box, n_box, 3e-7, random) < 1e-12);

    const double radius = 0.4, height = 0.9, slant = std::hypot(radius, height);
    const Vec3 n_cone(height / slant * std::cos(angle), height / slant * std::sin(angle), radius / slant);
    Sample cone = at_distance(Cone{radius, height}, ellipsoid, any_rotation(random), n_cone, -0.15);
    const Vec3 tip(0, 0, 0.75 * height),
        rim(radius * std::cos(angle), radius * std::sin(angle), -0.25 * height);
    cone.b_in_a.position += 0.2 * tip + 0.8 * rim - support(cone.a, n_cone);
    CHECK(error(cone, n_cone, 3e-7, random) < 1e-12);
  }
}

TEST_CASE("Newton's method leaves a normal that is next to no minimum") {
  std::mt19937 random(3);
  // Deeper than R = 0.6 m the depth is greatest here; at the corner of two boxes it has no minimum.
  const Sample deep =
      at_distance(Ellipsoid{0.3, 0.3, 0.3}, Ellipsoid{0.3, 0.3, 0.3}, Mat3::Identity(), unit_axis(2), -0.7);
  const Vec3 near = Vec3(1e-4, 0, 1).normalized();
  CHECK(inner::NewtonNormal{inner::Difference{deep.a, deep.b, deep.b_in_a}}(near) == near);
  const Vec3 n = Vec3(1, 2, 3).normalized();
  const Sample corners = at_distance(Box{1, 1, 1}, Box{1, 1, 1}, Mat3::Identity(), n, -0.1);
  CHECK(inner::NewtonNormal{inner::Difference{corners.a, corners.b, corners.b_in_a}}(n) == n);
}

}  // namespace newton_normal_tests
