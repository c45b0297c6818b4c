#include <delassus/math/linear.hpp>

#include <limits>

#include "catch.hpp"

using namespace delassus;

TEST_CASE("skew(a) b is the cross product, and skew(a) is antisymmetric") {
  const Vec3 a(1, -2, 3), b(0.5, 4, -1);
  // Small integers and halves: every product and sum is exact.
  REQUIRE(Vec3(skew(a) * b) == a.cross(b));
  REQUIRE(Mat3(skew(a).transpose()) == Mat3(-skew(a)));
}

TEST_CASE("skew keeps the scalar of its argument") {
  STATIC_REQUIRE(std::is_same_v<decltype(skew(Vec<3, float>())), Mat<3, 3, float>>);
}

TEST_CASE("a vector with one infinity or NaN is not finite") {
  const double infinity = std::numeric_limits<double>::infinity();
  const double nan = std::numeric_limits<double>::quiet_NaN();
  REQUIRE(is_finite(Vec3(1, -2, 3)));
  REQUIRE(is_finite(Vec3(std::numeric_limits<double>::max(), std::numeric_limits<double>::max(), 0)));
  REQUIRE_FALSE(is_finite(Vec3(1, infinity, 3)));
  REQUIRE_FALSE(is_finite(Vec3(infinity, -infinity, 3)));
  REQUIRE_FALSE(is_finite(Vec3(1, 2, nan)));
}
