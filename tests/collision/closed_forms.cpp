#include "catch.hpp"
#include "collision/acceptance.hpp"

#include <delassus/collision/closed_forms.hpp>

#include <cmath>

namespace closed_forms_tests {

using namespace delassus;
using namespace samples;

namespace {

/// The sphere of radius 0.1 at `centre` against `s`.
SignedPair ball_at(const Shape& s, const Vec3& centre, const Vec3& wish = Vec3::Zero()) {
  SignedPair r;
  REQUIRE(closed_form(s, Sphere{0.1}, Pose{.position = centre}, wish, r));
  return r;
}

}  // namespace

// GJK and EPA know nothing of the formulas; they promise 1e-9 of the size.
TEST_CASE("every formula gives what the general kernel gives") {
  const Zoo zoo;
  std::mt19937 random(21);
  int asked = 0;
  for (const Depth depth : depths)
    for_each_pair(zoo.all, [&](const Shape& a, const Shape& b) {
      for (int k = 0; k < 20; ++k) {
        double apart = 0;
        const Sample s = any_pose(a, b, depth, k % 2 == 1, random, apart);
        SignedPair r;
        if (!closed_form(a, b, s.b_in_a, Vec3::Zero(), r)) continue;
        const SignedPair general = GjkEpa::convex(a, b, s.b_in_a, 10, Vec3::Zero());
        CAPTURE(name(a.kind), name(b.kind), int(depth), r.distance, general.distance);
        CHECK(std::abs(r.distance - general.distance) < 2e-9);
        CHECK(std::abs(s.reach(r.normal) + r.distance) < 1e-14);
        CHECK((r.point_b - r.point_a - r.distance * r.normal).norm() < 1e-14);
        ++asked;
      }
    });
  CHECK(asked == 6 * 20 * 7);  // a sphere with all but the hull, and two capsules
}

TEST_CASE("a sphere meets a cone's mantle, base, rim and tip where geometry says") {
  const Shape cone = Cone{0.3, 0.4};  // base at z = −0.1, tip at 0.3, the mantle's normal (0.8, 0, 0.6)
  const Vec3 middle_of_mantle(0.15, 0, 0.1), mantle(0.8, 0, 0.6);
  const SignedPair side = ball_at(cone, middle_of_mantle + 0.25 * mantle);
  CHECK(side.distance == Approx(0.15).epsilon(1e-14));
  CHECK((side.normal - mantle).norm() < 1e-14);
  CHECK(ball_at(cone, {0.1, 0.1, -0.5}).distance == Approx(0.3).epsilon(1e-14));
  CHECK(ball_at(cone, {0, 0.6, -0.5}).distance == Approx(0.4).epsilon(1e-14));  // 0.3 out, 0.4 below the rim
  CHECK((ball_at(cone, {0, 0.6, -0.5}).normal - Vec3(0, 0.6, -0.8)).norm() < 1e-14);
  CHECK(ball_at(cone, {0, 0, 1}).distance == Approx(0.6).epsilon(1e-14));
  // At the centre of mass the base is 0.1 away, the mantle 0.24 · 0.75 = 0.18.
  CHECK(ball_at(cone, Vec3::Zero()).distance == Approx(-0.2).epsilon(1e-14));
  CHECK((ball_at(cone, Vec3::Zero()).normal + Vec3::UnitZ()).norm() < 1e-14);
}

TEST_CASE("a sphere inside an ellipsoid leaves along the least axis, on the side wished for") {
  const Shape egg = Ellipsoid{0.5, 0.3, 0.4};
  for (const double side : {1.0, -1.0}) {
    const SignedPair r = ball_at(egg, Vec3::Zero(), {0.1, side, 0.2});
    CHECK(r.distance == Approx(-0.4).epsilon(1e-14));
    CHECK((r.normal - side * Vec3::UnitY()).norm() < 1e-14);
  }
  // On the long axis, nearer to the centre than a − b²/a: the nearest point lies off the axis, at x = a²
  // p/(a² − b²).
  const double p = 0.1, x = 0.25 * p / 0.16, y = 0.3 * std::sqrt(1 - x * x / 0.25);
  CHECK(ball_at(egg, {p, 0, 0}, Vec3::UnitY()).distance ==
        Approx(-std::hypot(x - p, y) - 0.1).epsilon(1e-14));
  // Nearer to its end, the end itself.
  CHECK(ball_at(egg, {0.45, 0, 0}).distance == Approx(-0.15).epsilon(1e-13));
}

TEST_CASE("an ellipsoid of any proportions has its nearest point on it, right above") {
  std::mt19937 random(3);
  std::normal_distribution<double> normal;
  for (int k = 0; k < 3000; ++k) {
    Vec3 axes, p;
    for (int i = 0; i < 3; ++i) axes[i] = std::exp(3 * normal(random)), p[i] = normal(random) * axes[i];
    if (k % 3 == 0) axes[1] = axes[0];
    if (k % 5 == 0) p[k % 3] = 0;
    if (k % 7 == 0) p *= 1e-8;
    if (k % 11 == 0) p *= 1e3;
    const auto s = inner::nearest_surface_of_ellipsoid(axes, p, Vec3(1, 2, 3));
    const Vec3 foot = p - s.distance * s.normal;
    const double size = std::max(axes.maxCoeff(), p.norm());
    // The one point of the surface with this normal is the foot.
    CHECK((support(Ellipsoid{axes[0], axes[1], axes[2]}, s.normal) - foot).norm() < 1e-13 * size);
  }
}

}  // namespace closed_forms_tests
